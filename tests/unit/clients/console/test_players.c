/* Players: known by their keys, as many as there is room for, and active for a time. */
#include "clients/console/players.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define SECOND 1000000000ull

static void test_players_are_known_by_their_keys(void **state)
{
    static struct players players;
    uint8_t key[PLAYERS_KEY_BYTES] = {0};
    char first[PLAYERS_KEY_MAX];
    (void)state;
    for (uint32_t i = 0; i < PLAYERS_MAX; i++) {
        key[0] = (uint8_t)(i + 1);
        struct player *player = players_join(&players, "Ann", key, 100 + i, SECOND);
        assert_non_null(player);
        assert_int_equal(player->number, i + 1);
        if (i == 0)
            memcpy(first, player->key, sizeof first);
    }
    assert_null(players_join(&players, "Bob", key, 1, SECOND));
    assert_int_equal(players_find(&players, first)->source, 100);
    assert_null(players_find(&players, ""));
    assert_null(players_find(&players, "00000000000000000000000000000000"));
    struct player *player = players_find(&players, first);
    player->vehicle = 12;
    assert_ptr_equal(players_driver_of(&players, 12), player);
    assert_null(players_driver_of(&players, 0));
    assert_true(players_is_active(player, SECOND + PLAYERS_HOLD_NS - 1));
    assert_false(players_is_active(player, SECOND + PLAYERS_HOLD_NS));
    player->number = 0; /* left */
    assert_null(players_find(&players, first));
    assert_non_null(players_join(&players, "Bob", key, 1, SECOND));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_players_are_known_by_their_keys),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
