/* Who plays. */
#include "console/players.h"

#include "console/secret.h"

#include <string.h>

_Static_assert(PLAYERS_KEY_BYTES == SECRET_BYTES, "a key is a secret");

/* Bytes of the UTF-8 character at c, 0 when it is none. Overlong forms and surrogates are none. */
static size_t character_bytes(const unsigned char *c)
{
    size_t bytes = c[0] < 0x80 ? 1 : c[0] < 0xc2 ? 0 : c[0] < 0xe0 ? 2 : c[0] < 0xf0 ? 3 : 4;
    if (c[0] > 0xf4)
        return 0;
    for (size_t i = 1; i < bytes; i++) {
        if ((c[i] & 0xc0) != 0x80)
            return 0;
    }
    if ((c[0] == 0xe0 && c[1] < 0xa0) || (c[0] == 0xed && c[1] > 0x9f) ||
        (c[0] == 0xf0 && c[1] < 0x90) || (c[0] == 0xf4 && c[1] > 0x8f))
        return 0;
    return bytes;
}

bool players_name_ok(const char *name)
{
    const unsigned char *c = (const unsigned char *)name;
    bool blank = true;
    if (strlen(name) >= PLAYERS_NAME_MAX)
        return false;
    while (*c) {
        size_t bytes = character_bytes(c);
        bool control = *c < 0x20 || *c == 0x7f || (*c == 0xc2 && c[1] < 0xa0);
        /* Marks that turn the direction of writing would make one name look like another. */
        bool mark = bytes == 3 && c[0] == 0xe2 && (c[1] == 0x80 || c[1] == 0x81) && c[2] >= 0x8b;
        if (bytes == 0 || control || mark)
            return false;
        blank = blank && *c == ' ';
        c += bytes;
    }
    return !blank;
}

struct player *players_join(struct players *players, const char *name,
                            const uint8_t key[PLAYERS_KEY_BYTES], uint64_t source, uint64_t now_ns)
{
    for (uint32_t i = 0; i < PLAYERS_MAX; i++) {
        struct player *player = &players->player[i];
        if (player->number)
            continue;
        *player =
            (struct player){.number = ++players->joined, .source = source, .heard_ns = now_ns};
        strncpy(player->name, name, sizeof player->name - 1);
        secret_text(player->key, key);
        return player;
    }
    return NULL;
}

struct player *players_find(struct players *players, const char *key)
{
    struct player *found = NULL;
    for (uint32_t i = 0; i < PLAYERS_MAX; i++) {
        if (secret_equal(players->player[i].key, key) && players->player[i].number)
            found = &players->player[i];
    }
    return found;
}

const struct player *players_driver(const struct players *players, uint32_t vehicle)
{
    for (uint32_t i = 0; i < PLAYERS_MAX; i++) {
        const struct player *player = &players->player[i];
        if (player->number && vehicle && player->vehicle == vehicle)
            return player;
    }
    return NULL;
}

bool players_present(const struct player *player, uint64_t now_ns)
{
    return now_ns < player->heard_ns + PLAYERS_HOLD_NS;
}

void players_drop(struct player *player, const char *why)
{
    player->vehicle = player->wanted = 0;
    player->sent = 0;
    player->controls = player->accepted = (struct controls){0};
    memset(player->lost, 0, sizeof player->lost);
    strncpy(player->lost, why, sizeof player->lost - 1);
}
