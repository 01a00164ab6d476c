/* The tables of behaviour. Rows that most doctrines share are macros. An earlier row of a table
 * takes precedence over the later ones. */
#include "mover/agent/behaviour_table.h"

#include <stddef.h>

#define RESUPPLY_S  20
#define REARM_S     120 /* of a helicopter */
#define REARM_JET_S 300
#define FLEE_S      30
#define DASH_S      15
#define BACK_OFF_S  3
#define WAY_OUT_S   4  /* it backs off from where it is stuck, up to 3 s longer */
#define MOVE_S      20 /* to another firing position, at most: 90 m backwards */
#define COVER_S     20 /* behind cover from bursts; a land vehicle draws its own time */

#define B(name) (1u << BEHAVIOUR_##name)
#define P(name) (1u << PERCEPT_##name)

/* It carries out its order. */
#define CALM (B(IDLE) | B(PATROL) | B(ROUTE) | B(FOLLOW) | B(SCRIPT))
/* Its agent is in control: it is neither driven nor holding a course. */
#define OWN    (CALM | B(ATTACK) | B(FLEE) | B(BACK_OFF) | B(WITHDRAW) | B(RESUPPLY) | B(REPOSITION))
#define MOVING (OWN & ~(B(IDLE) | B(RESUPPLY)))

#define ORDER    BEHAVIOUR_TABLE_ORDER
#define TO(name) BEHAVIOUR_##name
#define AS(name) REASON_##name

#define ROW(behaviours, all_of, none_of, next, reason, seconds)                                    \
    {                                                                                              \
        .from = (behaviours), .when = (all_of), .unless = (none_of), .to = (next),                 \
        .because = (reason), .time_s = (seconds)                                                   \
    }

/* An agent without fuel stops, and a driver who sends no more commands loses the vehicle. */
#define BY_NECESSITY                                                                               \
    ROW(OWN & ~B(IDLE), P(NO_FUEL), 0, TO(IDLE), AS(OUT_OF_FUEL), 0),                              \
        ROW(B(DRIVEN), P(LEASE_OVER), 0, ORDER, AS(LEASE_OVER), 0)

/* The ends of a fight. */
#define FIGHTS_END                                                                                 \
    ROW(B(ATTACK), P(TARGET_GONE), 0, ORDER, AS(TARGET_GONE), 0),                                  \
        ROW(B(ATTACK), P(TIME_OVER), 0, ORDER, AS(LOST_SIGHT), 0),                                 \
        ROW(B(ATTACK), 0, P(ARMED) | P(NO_ROUNDS), ORDER, AS(COMMAND), 0)

/* It goes to its base for rounds and fuel, and back. */
#define SUPPLIES(time_s)                                                                           \
    ROW(B(WITHDRAW), P(ARRIVED), 0, TO(RESUPPLY), AS(ARRIVED), time_s),                            \
        ROW(B(RESUPPLY), P(TIME_OVER), 0, ORDER, AS(SUPPLIED), 0),                                 \
        ROW(CALM | B(ATTACK), P(NO_ROUNDS), P(STAND), TO(WITHDRAW), AS(OUT_OF_ROUNDS), 0),         \
        ROW(B(ATTACK), P(NO_ROUNDS), 0, ORDER, AS(OUT_OF_ROUNDS), 0),                              \
        ROW(CALM | B(ATTACK), P(LOW_FUEL), P(STAND), TO(WITHDRAW), AS(LOW_FUEL), 0)

/* It backs off from an obstacle that it ran into, or from where it is stuck, and then goes on. One
 * that is stuck fast, as a jeep in a crater, gives up its order. */
#define BUMPS                                                                                      \
    ROW(MOVING, P(BUMP), 0, TO(BACK_OFF), AS(COLLISION), BACK_OFF_S),                              \
        ROW(MOVING, P(STUCK_FAST), 0, TO(IDLE), AS(STUCK), 0),                                     \
        ROW(MOVING, P(STALLED), 0, TO(BACK_OFF), AS(STUCK), WAY_OUT_S),                            \
        ROW(B(BACK_OFF), P(TIME_OVER) | P(TARGET) | P(ARMED) | P(BRAVE), 0, TO(ATTACK),            \
            AS(TIME_OVER), BEHAVIOUR_TABLE_FIGHT_S),                                               \
        ROW(B(BACK_OFF), P(TIME_OVER) | P(TARGET), P(STAND), TO(FLEE), AS(TIME_OVER), DASH_S),     \
        ROW(B(BACK_OFF), P(TIME_OVER), 0, ORDER, AS(TIME_OVER), 0),                                \
        ROW(B(FLEE), P(TIME_OVER), 0, ORDER, AS(TIME_OVER), 0)

/* It is fired upon while it carries out its order. A crew that will fight fights from cover if that
 * is near. */
#define COVERS                                                                                     \
    ROW(CALM, P(SHOT) | P(ARMED) | P(BRAVE) | P(COVER), P(STAND), TO(REPOSITION), AS(FIRED_UPON),  \
        MOVE_S)

/* It is fired upon. A fight then lasts longer, and so does a flight, away from the last shooter. */
#define SHOT_AT(fleeing, time_s)                                                                   \
    ROW(B(ATTACK), P(SHOT), 0, TO(ATTACK), AS(FIRED_UPON), BEHAVIOUR_TABLE_FIGHT_S),               \
        ROW(CALM | B(RESUPPLY) | B(BACK_OFF), P(SHOT) | P(ARMED) | P(BRAVE), 0, TO(ATTACK),        \
            AS(FIRED_UPON), BEHAVIOUR_TABLE_FIGHT_S),                                              \
        ROW(CALM | B(RESUPPLY) | B(BACK_OFF) | B(FLEE), P(SHOT), P(STAND), TO(fleeing),            \
            AS(FIRED_UPON), time_s)

/* When half of its group is lost it goes home. */
#define LOSSES_END_IT                                                                              \
    ROW(CALM | B(ATTACK) | B(REPOSITION), P(SHOT) | P(LOSSES), P(STAND), TO(WITHDRAW), AS(LOSSES), \
        0)

/* A burst near it drives it into cover; an aircraft evades. */
#define SUPPRESSES(brave, time_s)                                                                  \
    ROW(CALM | B(ATTACK) | B(REPOSITION), P(SUPPRESSED), P(STAND) | (brave), TO(FLEE),             \
        AS(SUPPRESSED), time_s)

/* After some rounds it changes its place, and turns to its target again. */
#define SHOOTS_AND_MOVES                                                                           \
    ROW(B(ATTACK), P(ROUNDS_FIRED) | P(TARGET), P(STAND), TO(REPOSITION), AS(ROUNDS_FIRED),        \
        MOVE_S),                                                                                   \
        ROW(B(REPOSITION), P(TARGET_GONE), 0, ORDER, AS(TARGET_GONE), 0),                          \
        ROW(B(REPOSITION), P(ARRIVED), 0, TO(ATTACK), AS(ARRIVED), BEHAVIOUR_TABLE_FIGHT_S),       \
        ROW(B(REPOSITION), P(TIME_OVER), 0, TO(ATTACK), AS(TIME_OVER), BEHAVIOUR_TABLE_FIGHT_S)

/* An aircraft flies home for rounds when its passes are over. */
#define LEAVES ROW(B(ATTACK), P(ROUNDS_FIRED), P(STAND), TO(WITHDRAW), AS(ROUNDS_FIRED), 0)

#define SEES_ENEMY                                                                                 \
    ROW(B(IDLE) | B(PATROL) | B(ROUTE) | B(FOLLOW), P(ENEMY) | P(ARMED) | P(AT_WILL),              \
        P(OUTGUNNED), TO(ATTACK), AS(ENEMY_SEEN), BEHAVIOUR_TABLE_FIGHT_S)

/* It takes cover from whom its rounds cannot harm. */
#define OUTGUNNED(time_s)                                                                          \
    ROW(CALM | B(ATTACK) | B(REPOSITION) | B(RESUPPLY) | B(BACK_OFF), P(SHOT) | P(OUTGUNNED),      \
        P(STAND), TO(FLEE), AS(FIRED_UPON), time_s),                                               \
        ROW(B(IDLE) | B(PATROL) | B(ROUTE) | B(FOLLOW),                                            \
            P(ENEMY) | P(ARMED) | P(AT_WILL) | P(OUTGUNNED), P(STAND), TO(FLEE), AS(ENEMY_SEEN),   \
            DASH_S)

/* When its courage fails it withdraws, or flees for a while. */
#define HURT_GOES_HOME                                                                             \
    ROW(CALM | B(ATTACK), P(HURT), P(BRAVE) | P(STAND) | P(BUMP), TO(WITHDRAW), AS(HURT), 0)
#define ODDS(to, time_s)                                                                           \
    ROW(B(ATTACK), P(OUTNUMBERED), P(BRAVE) | P(STAND), TO(to), AS(OUTNUMBERED), time_s)

/* Tanks and carriers flee from odds and damage, into cover. */
static const struct behaviour_table_row armour[] = {
    BY_NECESSITY,
    FIGHTS_END,
    SUPPLIES(RESUPPLY_S),
    ROW(B(ATTACK), P(HURT), P(BRAVE) | P(STAND) | P(BUMP), TO(FLEE), AS(HURT), FLEE_S),
    LOSSES_END_IT,
    SUPPRESSES(P(BRAVE), COVER_S),
    OUTGUNNED(FLEE_S),
    COVERS,
    SHOT_AT(FLEE, FLEE_S),
    ODDS(FLEE, FLEE_S),
    BUMPS,
    SHOOTS_AND_MOVES,
    SEES_ENEMY,
};

/* Air defence fires from where it is, and flees from odds and bursts. */
static const struct behaviour_table_row flak[] = {
    BY_NECESSITY,
    FIGHTS_END,
    SUPPLIES(RESUPPLY_S),
    LOSSES_END_IT,
    SUPPRESSES(P(BRAVE), COVER_S),
    OUTGUNNED(FLEE_S),
    COVERS,
    SHOT_AT(FLEE, FLEE_S),
    ODDS(FLEE, FLEE_S),
    BUMPS,
    SHOOTS_AND_MOVES,
    SEES_ENEMY,
};

/* Jeeps withdraw when they are hit or outnumbered. */
static const struct behaviour_table_row light[] = {
    BY_NECESSITY,
    FIGHTS_END,
    SUPPLIES(RESUPPLY_S),
    ROW(CALM | B(ATTACK) | B(FLEE), P(HURT), P(STAND) | P(BUMP), TO(WITHDRAW), AS(HURT), 0),
    LOSSES_END_IT,
    SUPPRESSES(0, COVER_S),
    OUTGUNNED(FLEE_S),
    COVERS,
    SHOT_AT(FLEE, FLEE_S),
    ODDS(WITHDRAW, 0),
    BUMPS,
    SHOOTS_AND_MOVES,
    SEES_ENEMY,
};

/* Trucks flee when they see an enemy. */
static const struct behaviour_table_row soft[] = {
    BY_NECESSITY,
    FIGHTS_END,
    SUPPLIES(RESUPPLY_S),
    ROW(CALM | B(FLEE), P(HURT), P(STAND) | P(BUMP), TO(WITHDRAW), AS(HURT), 0),
    OUTGUNNED(FLEE_S),
    SHOT_AT(FLEE, FLEE_S),
    ROW(B(PATROL) | B(ROUTE), P(ENEMY), P(STAND) | P(AT_WILL), TO(FLEE), AS(ENEMY_SEEN), DASH_S),
    BUMPS,
    SEES_ENEMY,
};

/* Helicopters flee only for a short time, and withdraw when they are hit. */
static const struct behaviour_table_row helicopter[] = {
    BY_NECESSITY,
    FIGHTS_END,
    SUPPLIES(REARM_S),
    HURT_GOES_HOME,
    LOSSES_END_IT,
    SUPPRESSES(0, COVER_S),
    OUTGUNNED(DASH_S),
    SHOT_AT(FLEE, DASH_S),
    ODDS(FLEE, DASH_S),
    BUMPS,
    LEAVES,
    SEES_ENEMY,
};

/* Jets do not react to odds and do not back off. Low fuel ends their fights. */
static const struct behaviour_table_row jet[] = {
    BY_NECESSITY,
    FIGHTS_END,
    SUPPLIES(REARM_JET_S),
    HURT_GOES_HOME,
    LOSSES_END_IT,
    SUPPRESSES(0, COVER_S),
    SHOT_AT(FLEE, DASH_S),
    ROW(B(FLEE), P(TIME_OVER), 0, ORDER, AS(TIME_OVER), 0),
    LEAVES,
    SEES_ENEMY,
};

/* Ships cannot hide. They fight, or keep their distance. */
static const struct behaviour_table_row warship[] = {
    BY_NECESSITY,          FIGHTS_END, SUPPLIES(RESUPPLY_S), HURT_GOES_HOME,
    SHOT_AT(FLEE, FLEE_S), BUMPS,      SEES_ENEMY,
};

/* Beasts do not react to odds, damage or empty guns. */
static const struct behaviour_table_row beast[] = {
    BY_NECESSITY,
    ROW(B(ATTACK), P(TARGET_GONE), 0, ORDER, AS(TARGET_GONE), 0),
    ROW(B(ATTACK), P(TIME_OVER), 0, ORDER, AS(LOST_SIGHT), 0),
    ROW(CALM | B(ATTACK), P(SHOT) | P(BRAVE), 0, TO(ATTACK), AS(FIRED_UPON),
        BEHAVIOUR_TABLE_FIGHT_S),
    OUTGUNNED(FLEE_S),
    ROW(CALM | B(FLEE), P(SHOT), P(STAND), TO(FLEE), AS(FIRED_UPON), FLEE_S),
    BUMPS,
    SEES_ENEMY,
};

#define TABLE(rows_of, how, share, time_s)                                                         \
    {                                                                                              \
        .row = (rows_of), .rows = sizeof(rows_of) / sizeof((rows_of)[0]), .manner = (how),         \
        .stand_off = (share), .resupply_s = (time_s)                                               \
    }

const struct behaviour_table behaviour_tables[DOCTRINE_COUNT] = {
    [DOCTRINE_ARMOUR] = TABLE(armour, MANNER_STAND_OFF, 0.5, RESUPPLY_S),
    [DOCTRINE_LIGHT] = TABLE(light, MANNER_STAND_OFF, 0.7, RESUPPLY_S),
    [DOCTRINE_SOFT] = TABLE(soft, MANNER_STAND_OFF, 0.8, RESUPPLY_S),
    [DOCTRINE_HELICOPTER] = TABLE(helicopter, MANNER_HOVER, 0.45, REARM_S),
    [DOCTRINE_JET] = TABLE(jet, MANNER_PASS, 0.8, REARM_JET_S),
    [DOCTRINE_WARSHIP] = TABLE(warship, MANNER_STAND_OFF, 0.6, RESUPPLY_S),
    [DOCTRINE_BEAST] = TABLE(beast, MANNER_CHARGE, 0.0, RESUPPLY_S),
    [DOCTRINE_FLAK] = TABLE(flak, MANNER_STAND_OFF, 0.8, RESUPPLY_S),
};

static bool applies(const struct behaviour_table_row *row, uint32_t percepts)
{
    return (percepts & row->when) == row->when && !(percepts & row->unless);
}

const struct behaviour_table_row *behaviour_table_next(const struct behaviour_table *table,
                                                       enum behaviour behaviour, uint32_t percepts)
{
    for (uint32_t n = 0; n < table->rows; n++) {
        const struct behaviour_table_row *row = &table->row[n];
        if ((row->from >> behaviour & 1u) && applies(row, percepts))
            return row;
    }
    return NULL;
}

bool behaviour_table_differs(const struct behaviour_table *table, enum behaviour behaviour,
                             uint32_t percepts, uint32_t also)
{
    for (uint32_t n = 0; n < table->rows; n++) {
        const struct behaviour_table_row *row = &table->row[n];
        if (!(row->from >> behaviour & 1u) || ((percepts | also) & row->when) != row->when)
            continue; /* it applies neither way */
        bool without = applies(row, percepts), with = applies(row, percepts | also);
        if (without || with)
            return without != with;
    }
    return false;
}
