/* Settings of the terminal, and the signals at which they are restored. */
#include "clients/drive/terminal.h"

#include "clients/drive/terminal_keys.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

/* Leaves the alternate screen, shows the cursor, resets the attributes. */
#define SCREEN_RESTORE "\033[?1049l\033[?25h\033[0m\r\n"

static struct {
    struct termios before;
    volatile sig_atomic_t changed, protocol_on, screen, resized;
} terminal;

static void write_all(const char *text)
{
    ssize_t written = write(STDOUT_FILENO, text, strlen(text));
    (void)written; /* an error cannot be reported: the process ends */
}

void terminal_restore(void)
{
    if (terminal.protocol_on)
        write_all(TERMINAL_KEYS_DISABLE);
    if (terminal.screen)
        write_all(SCREEN_RESTORE);
    if (terminal.changed)
        (void)tcsetattr(STDIN_FILENO, TCSAFLUSH, &terminal.before);
    terminal.protocol_on = terminal.screen = terminal.changed = 0;
}

/* Runs once because of SA_RESETHAND, so that raise() then has the signal's default effect. */
static void on_crash(int signal_number)
{
    terminal_restore();
    (void)raise(signal_number);
}

static void on_resize(int signal_number)
{
    (void)signal_number;
    terminal.resized = 1;
}

/* The kernel's console misinterprets part of TERMINAL_KEYS_ENABLE. */
static bool supports_protocol(void)
{
    const char *type = getenv("TERM");
    return isatty(STDOUT_FILENO) && type && strcmp(type, "linux") != 0 && strcmp(type, "dumb") != 0;
}

void terminal_open(bool screen)
{
    static const int crashes[] = {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGQUIT, SIGALRM};
    struct sigaction crash = {.sa_handler = on_crash, .sa_flags = (int)SA_RESETHAND};
    struct sigaction resize = {.sa_handler = on_resize};
    struct termios raw;
    if (tcgetattr(STDIN_FILENO, &terminal.before) != 0)
        return; /* a pipe */
    for (size_t i = 0; i < sizeof crashes / sizeof crashes[0]; i++)
        (void)sigaction(crashes[i], &crash, NULL);
    (void)sigaction(SIGWINCH, &resize, NULL);
    raw = terminal.before;
    raw.c_lflag &= ~(tcflag_t)(ICANON | ECHO | IEXTEN);
    raw.c_iflag &= ~(tcflag_t)(IXON | ICRNL);
    raw.c_cc[VMIN] = 1;
    raw.c_cc[VTIME] = 0;
    raw.c_cc[VSUSP] = _POSIX_VDISABLE;
    (void)tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    terminal.changed = 1;
    terminal.screen = screen;
    if (supports_protocol()) {
        terminal.protocol_on = 1;
        write_all(TERMINAL_KEYS_ENABLE);
    }
}

bool terminal_resized(void)
{
    bool resized = terminal.resized != 0;
    terminal.resized = 0;
    return resized;
}
