/* Decodes the bytes of a terminal into intents. */
#include "clients/drive/terminal_keys.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define ESCAPE       '\033'
#define CTRL_C       3
#define CTRL_D       4
#define READ_AT_ONCE 256

/* Bits of the protocol's modifiers less one. */
#define MODIFIER_SHIFT 1
#define MODIFIER_CTRL  4

enum press { PRESS_DOWN = 1, PRESS_REPEAT, PRESS_UP };

/* A key moves an axis or triggers an action. */
struct binding {
    uint32_t code;
    int8_t direction; /* -1, 1: of the axis; 0: the key triggers the action */
    enum input_axis axis;
    enum input_action action;
};

#define BIND_AXIS(code, axis, direction)                                                           \
    {                                                                                              \
        (code), (direction), (axis), ACTION_COUNT                                                  \
    }
#define BIND_ACTION(code, action)                                                                  \
    {                                                                                              \
        (code), 0, AXIS_COUNT, (action)                                                            \
    }

static const struct binding bindings[] = {
    BIND_AXIS('w', AXIS_THROTTLE, 1),
    BIND_AXIS('s', AXIS_THROTTLE, -1),
    BIND_AXIS('d', AXIS_STEER, 1),
    BIND_AXIS('a', AXIS_STEER, -1),
    BIND_AXIS('r', AXIS_CLIMB, 1),
    BIND_AXIS('f', AXIS_CLIMB, -1),
    BIND_AXIS('b', AXIS_BRAKE, 1),
    BIND_AXIS(TERMINAL_KEYS_RIGHT, AXIS_AIM_X, 1),
    BIND_AXIS(TERMINAL_KEYS_LEFT, AXIS_AIM_X, -1),
    BIND_AXIS(TERMINAL_KEYS_UP, AXIS_AIM_Y, 1),
    BIND_AXIS(TERMINAL_KEYS_DOWN, AXIS_AIM_Y, -1),
    BIND_ACTION(' ', ACTION_FIRE),
    BIND_ACTION('t', ACTION_LOCK),
    BIND_ACTION('y', ACTION_UNLOCK),
    BIND_ACTION('x', ACTION_STOP),
    BIND_ACTION('g', ACTION_GEAR_UP),
    BIND_ACTION('v', ACTION_GEAR_DOWN),
    BIND_ACTION('n', ACTION_NEXT),
    BIND_ACTION('p', ACTION_PREVIOUS),
    BIND_ACTION('k', ACTION_NEAREST_KIND),
    BIND_ACTION('o', ACTION_NEAREST_FORCE),
    BIND_ACTION('1', ACTION_NEAREST_BLUE),
    BIND_ACTION('2', ACTION_NEAREST_RED),
    BIND_ACTION('0', ACTION_NEAREST_NEUTRAL),
    BIND_ACTION('u', ACTION_RELEASE),
    BIND_ACTION('\r', ACTION_TAKE),
    BIND_ACTION('\n', ACTION_TAKE),
    BIND_ACTION(',', ACTION_LOOK_LEFT),
    BIND_ACTION('.', ACTION_LOOK_RIGHT),
    BIND_ACTION('/', ACTION_LOOK_AHEAD),
    BIND_ACTION('+', ACTION_ZOOM_IN),
    BIND_ACTION('=', ACTION_ZOOM_IN),
    BIND_ACTION('-', ACTION_ZOOM_OUT),
    BIND_ACTION('h', ACTION_HELP),
    BIND_ACTION('?', ACTION_HELP),
    BIND_ACTION('q', ACTION_QUIT),
    BIND_ACTION(CTRL_C, ACTION_QUIT),
    BIND_ACTION(CTRL_D, ACTION_QUIT),
};

static const char *const help[][2] = {
    {"w s", "throttle up, down; the longer, the faster; through 0 into reverse"},
    {"a d", "steer left, right: wheel, rudder, stick"},
    {"r f", "climb, sink: stick or collective; of land vehicles r: hand brake"},
    {"b  x", "brake; stop: throttle 0, wheels straight"},
    {"g v", "gear up, down: reverse, neutral, low, automatic"},
    {"arrows", "turret left, right, gun up, down; aircraft: the stick"},
    {"t y", "lock the next enemy ahead, unlock"},
    {"space", "fire, at the locked target if there is one"},
    {"n p", "become the next, the previous vehicle"},
    {"k o", "become the nearest of this kind, of this force"},
    {"1 2 0", "become the nearest blue, red, neutral vehicle"},
    {"u  enter", "release to its agent; take it again"},
    {", . /", "look left, right, ahead: what is there, and t locks there"},
    {"+ -", "map nearer, wider"},
    {"h  q", "this help; release and quit"},
};

bool terminal_keys_help(uint32_t n, const char **keys, const char **meaning)
{
    if (n >= sizeof help / sizeof help[0])
        return false;
    *keys = help[n][0];
    *meaning = help[n][1];
    return true;
}

static void key(const struct terminal_keys *keys, uint32_t code, enum press press,
                struct intents *queue)
{
    if (code >= 'A' && code <= 'Z') /* shift and caps lock make no difference */
        code += 'a' - 'A';
    for (size_t i = 0; i < sizeof bindings / sizeof bindings[0]; i++) {
        const struct binding *b = &bindings[i];
        if (b->code != code)
            continue;
        if (b->direction != 0)
            intent_put(queue, (struct intent){.type = press == PRESS_UP ? INTENT_UP : INTENT_DOWN,
                                              .axis = b->axis,
                                              .value = (float)b->direction,
                                              .reports_release = keys->reports_release});
        else if (press == PRESS_DOWN)
            intent_act(queue, b->action);
        return;
    }
}

/* CSI code[:others] ; modifiers[:press] u, and CSI 1 ; modifiers[:press] A to D. */
static void protocol_key(struct terminal_keys *keys, const char *text, char last,
                         struct intents *queue)
{
    char *end;
    unsigned long code = strtoul(text, &end, 10);
    unsigned long modifiers = 1, press = PRESS_DOWN;
    end += strcspn(end, ";");
    if (*end == ';') {
        modifiers = strtoul(end + 1, &end, 10);
        if (*end == ':') {
            press = strtoul(end + 1, &end, 10);
            keys->reports_release = true;
        }
    }
    if (press < PRESS_DOWN || press > PRESS_UP)
        return;
    if (last >= 'A' && last <= 'D')
        code = TERMINAL_KEYS_UP + (unsigned long)(last - 'A');
    else if (modifiers > 0 && ((modifiers - 1) & MODIFIER_CTRL))
        code = code == 'c' ? CTRL_C : code == 'd' ? CTRL_D : 0;
    else if (modifiers > 0 && ((modifiers - 1) & MODIFIER_SHIFT) && code == '/')
        code = '?';
    if (code < TERMINAL_KEYS_UP || last != 'u')
        key(keys, (uint32_t)code, (enum press)press, queue);
}

/* Interprets a complete escape sequence. */
static void sequence(struct terminal_keys *keys, struct intents *queue)
{
    char last = keys->sequence[keys->length - 1];
    const char *text = keys->sequence + 2;
    keys->sequence[keys->length - 1] = '\0';
    if (keys->sequence[1] == 'O' && last >= 'A' && last <= 'D') {
        key(keys, TERMINAL_KEYS_UP + (uint32_t)(last - 'A'), PRESS_DOWN, queue);
    } else if (keys->sequence[1] == '[' && text[0] == '?') {
        if (last == 'u') /* reply to TERMINAL_KEYS_ENABLE: the parts that the terminal supports */
            keys->reports_release = (strtoul(text + 1, NULL, 10) & 2) != 0;
    } else if (keys->sequence[1] == '[' && (last == 'u' || (last >= 'A' && last <= 'D'))) {
        protocol_key(keys, text, last, queue);
    }
}

/* Returns true if the byte completes the sequence. */
static bool ends(const struct terminal_keys *keys, char byte)
{
    if (keys->length == 2)
        return byte != '[' && byte != 'O';
    return byte >= 0x40 && byte <= 0x7e;
}

void terminal_keys_decode(struct terminal_keys *keys, const char *bytes, size_t count,
                          struct intents *queue)
{
    for (size_t i = 0; i < count; i++) {
        char byte = bytes[i];
        if (byte == ESCAPE) { /* drops an unfinished sequence */
            keys->sequence[0] = byte;
            keys->length = 1;
        } else if (keys->length == 0) {
            key(keys, (unsigned char)byte, PRESS_DOWN, queue);
        } else if (keys->length == TERMINAL_KEYS_SEQUENCE_MAX - 1) {
            keys->length = 0;
        } else {
            keys->sequence[keys->length++] = byte;
            if (ends(keys, byte)) {
                sequence(keys, queue);
                keys->length = 0;
            }
        }
    }
}

static int terminal_keys_read(struct input *input, struct intents *queue)
{
    char bytes[READ_AT_ONCE];
    ssize_t count = read(input->fd, bytes, sizeof bytes);
    if (count < 0)
        return errno == EINTR || errno == EAGAIN ? 0 : -1;
    if (count == 0)
        return -1;
    terminal_keys_decode(input->state, bytes, (size_t)count, queue);
    return 0;
}

static void terminal_keys_close(struct input *input)
{
    free(input->state);
}

int terminal_keys_open(struct input *input, struct error_text *error)
{
    struct terminal_keys *keys = calloc(1, sizeof *keys);
    if (!keys)
        return error_text_set(error, "keys: out of memory");
    *input = (struct input){.fd = STDIN_FILENO,
                            .description = "keys",
                            .read = terminal_keys_read,
                            .close = terminal_keys_close,
                            .state = keys};
    return 0;
}
