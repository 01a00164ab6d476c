/* Keys of a terminal: decodes bytes into keys and translates keys into intents by a table.
 *
 * A plain terminal sends a byte for a press, the same byte again while the key is held, and nothing
 * at its release. A terminal with the Kitty keyboard protocol reports presses, repeats and
 * releases. The program asks for the protocol; the terminal's reply, or its first key in that form,
 * shows that it has the protocol. */
#ifndef JOLON_CLIENTS_DRIVE_TERMINAL_KEYS_H
#define JOLON_CLIENTS_DRIVE_TERMINAL_KEYS_H

#include "clients/drive/input.h"

#include <stddef.h>

/* Asks for the protocol, with unambiguous codes and releases of all keys, and for the terminal's
 * reply; ends the protocol. */
#define TERMINAL_KEYS_ENABLE  "\033[>11u\033[?u"
#define TERMINAL_KEYS_DISABLE "\033[<u"

/* Arrow keys, which are no characters. */
enum terminal_keys_code {
    TERMINAL_KEYS_UP = 0x110000,
    TERMINAL_KEYS_DOWN,
    TERMINAL_KEYS_RIGHT,
    TERMINAL_KEYS_LEFT
};

/* A longer escape sequence is dropped. */
#define TERMINAL_KEYS_SEQUENCE_MAX 32u

struct terminal_keys {
    char sequence[TERMINAL_KEYS_SEQUENCE_MAX]; /* [length] an unfinished escape sequence */
    uint32_t length;
    bool reports_release;
};

/* Decodes bytes; a sequence may be spread over several calls. Pure. */
void terminal_keys_decode(struct terminal_keys *keys, const char *bytes, size_t count,
                          struct intents *queue);

/* Fills keys and meaning with line n of the help, from 0: "w s", "throttle up, down". Returns false
 * after the last line. */
bool terminal_keys_help(uint32_t n, const char **keys, const char **meaning);

/* Opens standard input for keys. Returns 0, or -1 with the error. */
int terminal_keys_open(struct input *input, struct error_text *error);

#endif
