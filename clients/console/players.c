/* The list of players. */
#include "clients/console/players.h"

#include "clients/console/session_key.h"
#include "world/runtime/utf8.h"

#include <string.h>

_Static_assert(PLAYERS_KEY_BYTES == SESSION_KEY_BYTES, "session_key_text() writes players' keys");

bool players_name_is_valid(const char *name)
{
    uint32_t code, characters = 0;
    bool blank = true;
    while (*name) {
        size_t bytes = utf8_read(name, &code);
        if (bytes == 0 || !utf8_visible(code) || ++characters > PLAYERS_NAME_CHARACTERS)
            return false;
        blank = blank && *name == ' ';
        name += bytes;
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
        *player = (struct player){
            .number = ++players->joined, .source = source, .last_request_ns = now_ns};
        strncpy(player->name, name, sizeof player->name - 1);
        session_key_text(player->key, key);
        return player;
    }
    return NULL;
}

struct player *players_find(struct players *players, const char *key)
{
    struct player *found = NULL;
    for (uint32_t i = 0; i < PLAYERS_MAX; i++) {
        if (session_key_equal(players->player[i].key, key) && players->player[i].number)
            found = &players->player[i];
    }
    return found;
}

const struct player *players_driver_of(const struct players *players, uint32_t vehicle)
{
    for (uint32_t i = 0; i < PLAYERS_MAX; i++) {
        const struct player *player = &players->player[i];
        if (player->number && vehicle && player->vehicle == vehicle)
            return player;
    }
    return NULL;
}

bool players_is_active(const struct player *player, uint64_t now_ns)
{
    return now_ns < player->last_request_ns + PLAYERS_HOLD_NS;
}

void players_release_vehicle(struct player *player, const char *error)
{
    player->vehicle = player->wanted = 0;
    player->sent = 0;
    player->controls = player->accepted = (struct controls){0};
    memset(player->lost, 0, sizeof player->lost);
    strncpy(player->lost, error, sizeof player->lost - 1);
}
