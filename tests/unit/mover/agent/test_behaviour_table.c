/* The tables of behaviour: every row can apply, and each is exercised. */
#include "mover/agent/behaviour_table.h"
#include "tests/support/fixture.h"
#include "world/enum_names.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define SETS     (1u << PERCEPT_COUNT)
#define ROWS_MAX 64u
#define P(name)  (1u << PERCEPT_##name)

static const char *const names[PERCEPT_COUNT] = {
    "no fuel",  "shot",    "bump",       "hurt",      "time over",   "target",
    "gone",     "arrived", "lease over", "enemy",     "outnumbered", "no rounds",
    "low fuel", "armed",   "at will",    "stand",     "suppressed",  "stalled",
    "stuck",    "salvo",   "losses",     "outgunned", "cover",       "brave"};

static const char *said(uint32_t percepts)
{
    static char text[256];
    text[0] = '\0';
    for (uint32_t p = 0; p < PERCEPT_COUNT; p++) {
        if (percepts >> p & 1u)
            snprintf(text + strlen(text), sizeof text - strlen(text), "%s, ", names[p]);
    }
    return text;
}

/* Returns the percepts that rows from this behaviour ask for. */
static uint32_t asked(const struct behaviour_table *table, uint32_t behaviour)
{
    uint32_t percepts = 0;
    for (uint32_t n = 0; n < table->rows; n++) {
        if (table->row[n].from & 1u << behaviour)
            percepts |= table->row[n].when | table->row[n].unless;
    }
    return percepts;
}

/* Of every set of percepts, in every behaviour: the row that wins, by the definition alone. */
static const struct behaviour_table_row *oracle(const struct behaviour_table *table,
                                                uint32_t behaviour, uint32_t percepts)
{
    const struct behaviour_table_row *found = NULL;
    for (uint32_t n = table->rows; n > 0; n--) {
        const struct behaviour_table_row *row = &table->row[n - 1];
        bool from = (row->from & 1u << behaviour) != 0;
        bool all = (row->when & ~percepts) == 0, none = (row->unless & percepts) == 0;
        if (from && all && none)
            found = row;
    }
    return found;
}

static void test_row_9_every_row_of_every_table_can_win(void **state)
{
    (void)state;
    for (uint32_t d = 0; d < DOCTRINE_COUNT; d++) {
        const struct behaviour_table *table = &behaviour_tables[d];
        uint32_t won[ROWS_MAX] = {0}, behaviours[ROWS_MAX] = {0}, tries = 0;
        assert_true(table->rows > 0 && table->rows <= ROWS_MAX);
        for (uint32_t b = 0; b < BEHAVIOUR_COUNT; b++) {
            const uint32_t mask = asked(table, b), rest = (SETS - 1) & ~mask;
            uint32_t set = 0;
            do { /* all subsets of the mask, without and with all that nobody asks for */
                const struct behaviour_table_row *row =
                    behaviour_table_next(table, (enum behaviour)b, set);
                assert_ptr_equal(row, oracle(table, b, set));
                assert_ptr_equal(behaviour_table_next(table, (enum behaviour)b, set | rest), row);
                const uint32_t also = 3u << tries++ % (PERCEPT_COUNT - 1);
                assert_int_equal(behaviour_table_differs(table, (enum behaviour)b, set, also),
                                 oracle(table, b, set | also) != row);
                if (row) {
                    won[row - table->row]++;
                    behaviours[row - table->row] |= 1u << b;
                }
                set = (set - mask) & mask;
            } while (set != 0);
        }
        for (uint32_t n = 0; n < table->rows; n++) {
            if (won[n] == 0 || behaviours[n] != table->row[n].from)
                fail_msg("%s: row %u (to %s when %s) never wins, or from %x of %x only",
                         doctrine_name((enum doctrine)d), n,
                         behaviour_name((enum behaviour)table->row[n].to), said(table->row[n].when),
                         behaviours[n], table->row[n].from);
        }
    }
}

static void test_rows_are_sound(void **state)
{
    static const uint32_t timed = 1u << BEHAVIOUR_ATTACK | 1u << BEHAVIOUR_FLEE |
                                  1u << BEHAVIOUR_BACK_OFF | 1u << BEHAVIOUR_RESUPPLY |
                                  1u << BEHAVIOUR_REPOSITION;
    (void)state;
    for (uint32_t d = 0; d < DOCTRINE_COUNT; d++) {
        const struct behaviour_table *table = &behaviour_tables[d];
        assert_string_not_equal(doctrine_name((enum doctrine)d), "?");
        for (uint32_t n = 0; n < table->rows; n++) {
            const struct behaviour_table_row *row = &table->row[n];
            assert_true(row->to <= BEHAVIOUR_TABLE_ORDER && row->because < REASON_COUNT);
            assert_int_equal(row->when & row->unless, 0);
            assert_int_equal(row->from & 1u << BEHAVIOUR_HOLD, 0);
            assert_int_equal(row->from & 1u << BEHAVIOUR_FLIGHT, 0);
            assert_int_equal(row->time_s > 0, (timed >> row->to & 1u) != 0);
        }
    }
}

/* What each sort does about the same thing. */
static const struct {
    enum doctrine doctrine;
    enum behaviour from;
    uint32_t percepts;
    enum behaviour to; /* BEHAVIOUR_TABLE_ORDER; from itself: nothing happens */
    enum agent_reason because;
} cases[] = {
    {DOCTRINE_ARMOUR, BEHAVIOUR_PATROL, P(SHOT) | P(ARMED) | P(BRAVE), BEHAVIOUR_ATTACK,
     REASON_FIRED_UPON},
    {DOCTRINE_ARMOUR, BEHAVIOUR_PATROL, P(SHOT) | P(ARMED) | P(BRAVE) | P(COVER),
     BEHAVIOUR_REPOSITION, REASON_FIRED_UPON},
    {DOCTRINE_ARMOUR, BEHAVIOUR_PATROL, P(SHOT) | P(ARMED) | P(BRAVE) | P(COVER) | P(STAND),
     BEHAVIOUR_ATTACK, REASON_FIRED_UPON},
    {DOCTRINE_ARMOUR, BEHAVIOUR_PATROL, P(SHOT) | P(ARMED), BEHAVIOUR_FLEE, REASON_FIRED_UPON},
    {DOCTRINE_ARMOUR, BEHAVIOUR_PATROL, P(SHOT) | P(STAND), BEHAVIOUR_PATROL, 0},
    {DOCTRINE_ARMOUR, BEHAVIOUR_ATTACK, P(OUTNUMBERED) | P(ARMED), BEHAVIOUR_FLEE,
     REASON_OUTNUMBERED},
    {DOCTRINE_ARMOUR, BEHAVIOUR_ATTACK, P(OUTNUMBERED) | P(ARMED) | P(STAND), BEHAVIOUR_ATTACK, 0},
    {DOCTRINE_ARMOUR, BEHAVIOUR_ATTACK, P(HURT) | P(ARMED), BEHAVIOUR_FLEE, REASON_HURT},
    {DOCTRINE_ARMOUR, BEHAVIOUR_ATTACK, P(TARGET_GONE) | P(ARMED), BEHAVIOUR_TABLE_ORDER,
     REASON_TARGET_GONE},
    {DOCTRINE_ARMOUR, BEHAVIOUR_ATTACK, P(TIME_OVER) | P(ARMED), BEHAVIOUR_TABLE_ORDER,
     REASON_LOST_SIGHT},
    {DOCTRINE_ARMOUR, BEHAVIOUR_ATTACK, P(NO_ROUNDS), BEHAVIOUR_WITHDRAW, REASON_OUT_OF_ROUNDS},
    {DOCTRINE_ARMOUR, BEHAVIOUR_ATTACK, P(NO_ROUNDS) | P(STAND), BEHAVIOUR_TABLE_ORDER,
     REASON_OUT_OF_ROUNDS},
    {DOCTRINE_ARMOUR, BEHAVIOUR_PATROL, P(LOW_FUEL) | P(ARMED), BEHAVIOUR_WITHDRAW,
     REASON_LOW_FUEL},
    {DOCTRINE_ARMOUR, BEHAVIOUR_WITHDRAW, P(ARRIVED), BEHAVIOUR_RESUPPLY, REASON_ARRIVED},
    {DOCTRINE_ARMOUR, BEHAVIOUR_RESUPPLY, P(TIME_OVER), BEHAVIOUR_TABLE_ORDER, REASON_SUPPLIED},
    {DOCTRINE_ARMOUR, BEHAVIOUR_WITHDRAW, P(NO_FUEL), BEHAVIOUR_IDLE, REASON_OUT_OF_FUEL},
    {DOCTRINE_ARMOUR, BEHAVIOUR_PATROL, P(BUMP), BEHAVIOUR_BACK_OFF, REASON_COLLISION},
    {DOCTRINE_ARMOUR, BEHAVIOUR_IDLE, P(BUMP), BEHAVIOUR_IDLE, 0},
    {DOCTRINE_ARMOUR, BEHAVIOUR_BACK_OFF, P(TIME_OVER), BEHAVIOUR_TABLE_ORDER, REASON_TIME_OVER},
    {DOCTRINE_ARMOUR, BEHAVIOUR_BACK_OFF, P(TIME_OVER) | P(TARGET) | P(ARMED) | P(BRAVE),
     BEHAVIOUR_ATTACK, REASON_TIME_OVER},
    {DOCTRINE_ARMOUR, BEHAVIOUR_IDLE, P(ENEMY) | P(ARMED) | P(AT_WILL), BEHAVIOUR_ATTACK,
     REASON_ENEMY_SEEN},
    {DOCTRINE_ARMOUR, BEHAVIOUR_IDLE, P(ENEMY) | P(ARMED), BEHAVIOUR_IDLE, 0},
    {DOCTRINE_ARMOUR, BEHAVIOUR_DRIVEN, P(LEASE_OVER), BEHAVIOUR_TABLE_ORDER, REASON_LEASE_OVER},
    {DOCTRINE_ARMOUR, BEHAVIOUR_DRIVEN, P(SHOT) | P(ARMED) | P(BRAVE), BEHAVIOUR_DRIVEN, 0},
    {DOCTRINE_LIGHT, BEHAVIOUR_ATTACK, P(HURT) | P(ARMED), BEHAVIOUR_WITHDRAW, REASON_HURT},
    {DOCTRINE_LIGHT, BEHAVIOUR_ATTACK, P(OUTNUMBERED) | P(ARMED), BEHAVIOUR_WITHDRAW,
     REASON_OUTNUMBERED},
    {DOCTRINE_SOFT, BEHAVIOUR_ROUTE, P(ENEMY), BEHAVIOUR_FLEE, REASON_ENEMY_SEEN},
    {DOCTRINE_SOFT, BEHAVIOUR_ROUTE, P(SHOT), BEHAVIOUR_FLEE, REASON_FIRED_UPON},
    {DOCTRINE_HELICOPTER, BEHAVIOUR_ATTACK, P(HURT) | P(ARMED), BEHAVIOUR_WITHDRAW, REASON_HURT},
    {DOCTRINE_JET, BEHAVIOUR_ATTACK, P(OUTNUMBERED) | P(ARMED), BEHAVIOUR_ATTACK, 0},
    {DOCTRINE_WARSHIP, BEHAVIOUR_PATROL, P(SHOT) | P(ARMED) | P(BRAVE), BEHAVIOUR_ATTACK,
     REASON_FIRED_UPON},
    {DOCTRINE_BEAST, BEHAVIOUR_ATTACK, P(HURT) | P(OUTNUMBERED), BEHAVIOUR_ATTACK, 0},
    {DOCTRINE_ARMOUR, BEHAVIOUR_ATTACK, P(SUPPRESSED) | P(ARMED) | P(TARGET), BEHAVIOUR_FLEE,
     REASON_SUPPRESSED},
    {DOCTRINE_ARMOUR, BEHAVIOUR_ATTACK, P(SUPPRESSED) | P(ARMED) | P(TARGET) | P(BRAVE),
     BEHAVIOUR_ATTACK, 0},
    {DOCTRINE_ARMOUR, BEHAVIOUR_ATTACK, P(ROUNDS_FIRED) | P(ARMED) | P(TARGET),
     BEHAVIOUR_REPOSITION, REASON_ROUNDS_FIRED},
    {DOCTRINE_ARMOUR, BEHAVIOUR_ATTACK, P(ROUNDS_FIRED) | P(ARMED) | P(TARGET) | P(STAND),
     BEHAVIOUR_ATTACK, 0},
    {DOCTRINE_ARMOUR, BEHAVIOUR_REPOSITION, P(ARRIVED) | P(ARMED) | P(TARGET), BEHAVIOUR_ATTACK,
     REASON_ARRIVED},
    {DOCTRINE_ARMOUR, BEHAVIOUR_PATROL, P(SHOT) | P(LOSSES) | P(ARMED) | P(BRAVE),
     BEHAVIOUR_WITHDRAW, REASON_LOSSES},
    {DOCTRINE_ARMOUR, BEHAVIOUR_ATTACK, P(SHOT) | P(LOSSES) | P(ARMED) | P(STAND), BEHAVIOUR_ATTACK,
     0},
    {DOCTRINE_SOFT, BEHAVIOUR_ROUTE, P(STALLED), BEHAVIOUR_BACK_OFF, REASON_STUCK},
    {DOCTRINE_SOFT, BEHAVIOUR_BACK_OFF, P(STALLED), BEHAVIOUR_BACK_OFF, REASON_STUCK},
    {DOCTRINE_SOFT, BEHAVIOUR_BACK_OFF, P(STALLED) | P(STUCK_FAST), BEHAVIOUR_IDLE, REASON_STUCK},
    {DOCTRINE_JET, BEHAVIOUR_ATTACK, P(ROUNDS_FIRED) | P(ARMED) | P(TARGET), BEHAVIOUR_WITHDRAW,
     REASON_ROUNDS_FIRED},
    {DOCTRINE_JET, BEHAVIOUR_ATTACK, P(SUPPRESSED) | P(SHOT) | P(ARMED) | P(BRAVE), BEHAVIOUR_FLEE,
     REASON_SUPPRESSED},
    {DOCTRINE_FLAK, BEHAVIOUR_PATROL, P(ENEMY) | P(ARMED) | P(AT_WILL), BEHAVIOUR_ATTACK,
     REASON_ENEMY_SEEN},
};

static void test_row_9_each_sort_does_its_own_about_it(void **state)
{
    (void)state;
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        const struct behaviour_table_row *row = behaviour_table_next(
            &behaviour_tables[cases[n].doctrine], cases[n].from, cases[n].percepts);
        if (cases[n].to == cases[n].from ? row && row->to != cases[n].from : !row)
            fail_msg("case %zu", n);
        if (row && cases[n].to != cases[n].from) {
            assert_int_equal(row->to, cases[n].to);
            assert_int_equal(row->because, cases[n].because);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_9_every_row_of_every_table_can_win),
        cmocka_unit_test(test_rows_are_sound),
        cmocka_unit_test(test_row_9_each_sort_does_its_own_about_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
