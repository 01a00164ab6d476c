/* The shared memory of the model, the death of a process, and the law that holds after every store
 * (ipc/README.md, "Rules").
 *
 * A table has two cells, so that a torn table is seen. In frame f both cells of the world hold
 * WORLD(f), and both cells of the moved table MOVED(f). The mover adds one to the value that it
 * reads, and the collider adds one more. So a frame that is left out, or whose collisions are
 * answered twice, is seen too. */

#ifndef FRAMES
#define FRAMES 3
#endif

#define WORLD(f) (2 * (f))
#define MOVED(f) (2 * (f) - 1)
#define TORN     255 /* the value of a cell while its table is written */
#define NONE     255

/* --- frame words and tables ---------------------------------------------------------------------*/

byte commit;  /* only writer: collider */
byte writing; /* only writer: collider */
byte moved;   /* only writer: mover */

byte world_a[2], world_b[2]; /* the two cells of W[0] and W[1]; only writer: collider */
byte moved_a, moved_b;       /* the two cells of M; only writer: mover */

/* --- craters: an append-only table whose count is in the world's head -----------------------------*/

#ifdef CRATERS
#define CRATERS_OF(f)    ((f) & 1) /* every second frame makes one */
#define CRATERS_UNTIL(f) (((f) + 1) / 2)
byte crater[CRATERS_UNTIL(FRAMES) + 2]; /* crater i holds i + 1; mutants may add two */
byte crater_count[2];
#ifdef CRATER_COUNT_OUTSIDE
byte crater_count_word;
#endif
#endif

/* --- events: a ring whose end is in the world's head -----------------------------------------------*/

#ifdef EVENTS
#ifndef EVENT_SLOTS
#define EVENT_SLOTS 4
#endif
#define EVENTS_A_FRAME  2                         /* at most */
#define EVENTS_OF(f)    (1 + ((f) & 1))           /* 2, 1, 2, 1 ... */
#define EVENTS_UNTIL(f) ((f) + ((f) + 1) / 2)     /* their sum; an event holds its number in */
byte event_a[EVENT_SLOTS], event_b[EVENT_SLOTS];  /* the run, from 1, in both cells */
byte event_end[2];
#ifdef EVENT_END_OUTSIDE
byte event_end_word;
#endif
#endif

/* --- commands: a ring of another writer, and its cursor in the world's head -----------------------*/

#ifdef COMMANDS
#ifndef COMMAND_SLOTS
#define COMMAND_SLOTS 2
#endif
#define BIT(key)     (1 << ((key) - 1))
#define ALL_COMMANDS ((1 << COMMANDS) - 1)
byte command_a[COMMAND_SLOTS], command_b[COMMAND_SLOTS]; /* a slot holds a key, 1 .. COMMANDS */
byte command_head;                                       /* only writer: sender */
byte cursor[2], moved_cursor;
byte applied[2], moved_applied; /* the commands' effects: a set of keys */
#ifdef CURSOR_OUTSIDE
byte cursor_word;
#endif
#define FINISHED(f) (applied[(f) & 1] == ALL_COMMANDS)
#else
#define FINISHED(f) ((f) == FRAMES)
#endif

/* --- the law ------------------------------------------------------------------------------------*/

/* Tested after every store of any process: rule 1, and that the committed buffer is untorn and
 * holds its frame (rule 2). A set that starts relies on no more than this. */
#define LAW                                                                                        \
    assert(commit <= moved && moved <= commit + 1);                                                \
    assert(world_a[commit & 1] == WORLD(commit) && world_b[commit & 1] == WORLD(commit))

/* --- witnesses: situations that must occur, so that no check passes because they never do ----------*/

#define FRAME_AGAIN   1  /* a dead collider had begun the frame that this one makes */
#define ALL_DEAD      2  /* all processes are dead in the middle of a frame */
#define COPY_REJECTED 3  /* a reader's copy was overtaken */
#define EVENTS_WRAP   4  /* the event ring has gone round */
#define EVENTS_GAP    5  /* the recorder fell behind the ring */
#define EVENTS_LOST   6  /* the recorder fell behind while it copied */
#define TAIL_CUT      7  /* the recorder found a torn record */
#define COMMANDS_WRAP 8  /* the command ring has gone round */
#define COMMAND_KNOWN 9  /* a repeated command was found in the ring */
#define ANSWER_KNOWN  10 /* the history had the answer to a repeated command */
#define RING_FULL     11
#define ROLE_REFUSED  12 /* a second candidate found the role held */
#define BELL_LOST     13 /* the condition of a wait holds, and the bell did not ring */
#ifndef WITNESS
#define WITNESS 0
#endif
#define SEEN(what) assert(WITNESS != what)

/* --- death --------------------------------------------------------------------------------------*/

#ifdef KILLS /* the most kills in a run, for what must happen when kills end */
byte kills;
#define KILLED (kills < KILLS) -> kills++
#else
#define KILLED true
#endif

/* A store to shared memory, before which the process may be killed. */
#ifdef REPLACED_BEFORE_DEAD
/* Mutant: SIGKILL is sent and the role passed on, but the victim makes one more store. */
#define STORE(assignment)                                                                          \
    if                                                                                             \
    :: atomic { true -> assignment; LAW }                                                          \
    :: atomic { KILLED -> LEAVE };                                                                 \
       atomic { assignment; LAW; goto dead }                                                       \
    fi
#else
#define STORE(assignment)                                                                          \
    atomic {                                                                                       \
        if                                                                                         \
        :: true -> assignment; LAW                                                                 \
        :: KILLED -> goto dead                                                                     \
        fi                                                                                         \
    }
#endif

/* Stores both cells of a table. With COMMANDS this is one store, so that there are fewer states;
 * the other parts check torn tables. */
#ifdef COMMANDS
#define STORE_BOTH(first, second) STORE(first; second)
#else
#define STORE_BOTH(first, second) STORE(first); STORE(second)
#endif

/* The place for a kill after the last store of a frame. The waits that follow need no kill of their
 * own, because a process that waits has stored nothing since. So when all processes wait for ever,
 * spin reports it. */
#define MORTAL                                                                                     \
    atomic {                                                                                       \
        if                                                                                         \
        :: skip                                                                                    \
        :: KILLED -> goto dead                                                                     \
        fi                                                                                         \
    }

/* --- roles --------------------------------------------------------------------------------------*/

#define MOVER    0
#define COLLIDER 1
#define SENDER   2
#define RECORDER 3

/* With CANDIDATES two processes try to take each role, again and again, as in a double start, or
 * when a set starts while the old one dies. Rule 4: only death or the end of the run drops the
 * lock. */
#ifdef CANDIDATES
byte holder[2] = NONE;
#if defined(NO_LOCK)
#define TAKE  skip
#define LEAVE skip
#elif defined(REPLACED_ON_SILENCE)
/* Mutant: the role is a lease. A process that finds the holder silent takes over, and any holder
 * may be silent. */
#define TAKE  holder[role] = self
#define LEAVE if :: holder[role] == self -> holder[role] = NONE :: else fi
#else
#define TAKE                                                                                       \
    atomic {                                                                                       \
        if                                                                                         \
        :: holder[role] == NONE                                                                    \
        :: holder[role] != NONE -> SEEN(ROLE_REFUSED); holder[role] == NONE                        \
        fi;                                                                                        \
        holder[role] = self                                                                        \
    }
#define LEAVE if :: holder[role] == self -> holder[role] = NONE :: else fi
#endif
#else
#define TAKE  skip
#define LEAVE skip
#endif

/* The number of dead processes, counted only for its witness. */
#if WITNESS == ALL_DEAD
byte dead_ones;
#define DIES   dead_ones++; assert(dead_ones < 2 || writing == commit || moved == commit)
#define COMES  dead_ones--
#else
#define DIES   skip
#define COMES  skip
#endif
