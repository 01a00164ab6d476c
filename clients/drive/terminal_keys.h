/* Keys of a terminal. Bytes become keys, keys become intents by one table, which is also the help.
 *
 * Plain terminals send a byte for a press and the same again while the key is held; nothing when it
 * is let go. Terminals that know the Kitty keyboard protocol tell presses, repeats and releases:
 * we ask for it, and the answer, or the first such key, says that they do. */
#ifndef JOLON_CLIENTS_DRIVE_TERMINAL_KEYS_H
#define JOLON_CLIENTS_DRIVE_TERMINAL_KEYS_H

#include "clients/drive/input.h"

#include <stddef.h>

/* Asks for the protocol: keys without ambiguity, with their releases, all of them; then, what it
 * is. Takes it back. */
#define TERMINAL_KEYS_ENABLE  "\033[>11u\033[?u"
#define TERMINAL_KEYS_DISABLE "\033[<u"

/* Keys that are no character: arrows. */
enum terminal_keys_code {
    TERMINAL_KEYS_UP = 0x110000,
    TERMINAL_KEYS_DOWN,
    TERMINAL_KEYS_RIGHT,
    TERMINAL_KEYS_LEFT
};

/* An escape sequence that does not end within this is none. */
#define TERMINAL_KEYS_SEQUENCE_MAX 32u

struct terminal_keys {
    char sequence[TERMINAL_KEYS_SEQUENCE_MAX]; /* begun and not yet ended */
    uint32_t length;
    bool reports_release; /* the terminal tells releases */
};

/* Takes bytes as they came, in any pieces. Pure. */
void terminal_keys_decode(struct terminal_keys *keys, const char *bytes, size_t count,
                          struct intents *queue);

/* Line n of the help, from 0: "w s", "throttle up, down"; false after the last. */
bool terminal_keys_help(uint32_t n, const char **keys, const char **meaning);

/* Opens standard input for keys. 0, or -1 with the reason. */
int terminal_keys_open(struct input *input, struct error_text *error);

#endif
