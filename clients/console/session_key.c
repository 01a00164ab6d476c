/* Makes, reads and compares tokens and keys. */
#include "clients/console/session_key.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#define TOKEN_MIN 16u

bool session_key_equal(const char *kept, const char *given)
{
    size_t kept_bytes = strlen(kept), bytes = strlen(given);
    unsigned differs = kept_bytes != bytes || kept_bytes == 0;
    for (size_t i = 0; i < bytes; i++)
        differs |= (unsigned char)given[i] ^ (unsigned char)kept[kept_bytes ? i % kept_bytes : 0];
    return differs == 0;
}

void session_key_text(char text[SESSION_KEY_TEXT], const uint8_t bytes[SESSION_KEY_BYTES])
{
    for (size_t i = 0; i < SESSION_KEY_BYTES; i++)
        (void)snprintf(text + 2 * i, 3, "%02x", bytes[i]);
}

bool session_key_random(uint8_t bytes[SESSION_KEY_BYTES])
{
    return getrandom(bytes, SESSION_KEY_BYTES, 0) == (ssize_t)SESSION_KEY_BYTES;
}

static int make_file(char token[SESSION_KEY_MAX], const char *path, struct error_text *error)
{
    uint8_t bytes[SESSION_KEY_BYTES];
    char line[SESSION_KEY_TEXT + 1];
    if (!session_key_random(bytes))
        return error_text_set(error, "the system gives no random numbers");
    session_key_text(token, bytes);
    size_t count = (size_t)snprintf(line, sizeof line, "%s\n", token);
    int fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (fd < 0)
        return error_text_set(error, "--token-file %s: cannot make it: %s", path, strerror(errno));
    bool written = write(fd, line, count) == (ssize_t)count;
    if (close(fd) != 0 || !written)
        return error_text_set(error, "--token-file %s: cannot write it: %s", path, strerror(errno));
    return 0;
}

int session_key_file(char token[SESSION_KEY_MAX], const char *path, struct error_text *error)
{
    static const char letters[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
    char line[SESSION_KEY_MAX + 2];
    struct stat status;
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0)
        return errno == ENOENT
                   ? make_file(token, path, error)
                   : error_text_set(error, "--token-file %s: %s", path, strerror(errno));
    ssize_t count = fstat(fd, &status) == 0 ? read(fd, line, sizeof line - 1) : -1;
    close(fd);
    if (count < 0 || !S_ISREG(status.st_mode))
        return error_text_set(error, "--token-file %s: not a regular file that can be read", path);
    if (status.st_mode & 077)
        return error_text_set(error, "--token-file %s: others may read it; chmod 600 %s", path,
                              path);
    line[count] = '\0';
    size_t length = strspn(line, letters);
    if (length < TOKEN_MIN || length >= SESSION_KEY_MAX ||
        line[length + strspn(line + length, "\r\n")])
        return error_text_set(error,
                              "--token-file %s: needs one line of %u to %u letters, digits, - or _",
                              path, TOKEN_MIN, SESSION_KEY_MAX - 1);
    memcpy(token, line, length);
    token[length] = '\0';
    return 0;
}
