/* The shared memory of the model, how a process dies in it, and its law (ipc/README.md, "Rules").
 *
 * A frame is two cells a table, so that a torn one shows: in frame f both cells of the world hold
 * WORLD(f), both cells of the moved table MOVED(f). The mover adds one to what it reads, the
 * collider one more, so a frame that is answered twice or left out shows too. */

#ifndef FRAMES
#define FRAMES 3
#endif

#define WORLD(f) (2 * (f))
#define MOVED(f) (2 * (f) - 1)
#define TORN     255 /* what stands in a table while it is being worked on */
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
byte crater[CRATERS_UNTIL(FRAMES) + 2]; /* crater i holds i + 1; two to spare, for mutants */
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
#define EVENTS_UNTIL(f) ((f) + ((f) + 1) / 2)     /* and their sum: the key of an event is its */
byte event_a[EVENT_SLOTS], event_b[EVENT_SLOTS];  /* number in the run, from 1, in both cells */
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
byte command_a[COMMAND_SLOTS], command_b[COMMAND_SLOTS]; /* a command is its key, 1 .. COMMANDS */
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

/* Looked at after every store of whichever process: rule 1, and by rule 2 that the committed buffer
 * is whole and says its frame. This is also all that a set that starts now relies on. */
#define LAW                                                                                        \
    assert(commit <= moved && moved <= commit + 1);                                                \
    assert(world_a[commit & 1] == WORLD(commit) && world_b[commit & 1] == WORLD(commit))

/* --- witnesses: situations that must come up, so that no check passes for want of them -------------*/

#define FRAME_AGAIN   1  /* the collider finds its frame begun by one that died */
#define ALL_DEAD      2  /* every process dead at once in the middle of a frame */
#define COPY_REJECTED 3  /* a reader's copy was overtaken */
#define EVENTS_WRAP   4  /* the event ring has gone round */
#define EVENTS_GAP    5  /* the recorder fell behind it */
#define EVENTS_LOST   6  /* ... while it copied */
#define TAIL_CUT      7  /* the recorder found a torn record */
#define COMMANDS_WRAP 8  /* the command ring has gone round */
#define COMMAND_KNOWN 9  /* the ring's memory knew a repeated command */
#define COMMAND_BOOK  10 /* ... and its answer stood in the book */
#define RING_FULL     11
#define ROLE_REFUSED  12 /* a second candidate found the role held */
#define BELL_LOST     13 /* a process waits for what is there, and its bell is silent */
#ifndef WITNESS
#define WITNESS 0
#endif
#define SEEN(what) assert(WITNESS != what)

/* --- death --------------------------------------------------------------------------------------*/

#ifdef KILLS /* at most so many in a run: for what must come true when kills end */
byte kills;
#define KILLED (kills < KILLS) -> kills++
#else
#define KILLED true
#endif

/* A store to shared memory, before which the process may be killed. */
#ifdef REPLACED_BEFORE_DEAD
/* SIGKILL is sent and the role given away, but the victim gets one more store out. */
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

/* Two words of a table. Where commands are in play they are one store, to keep the states few: how
 * tables tear is looked at without them. */
#ifdef COMMANDS
#define STORE_BOTH(first, second) STORE(first; second)
#else
#define STORE_BOTH(first, second) STORE(first); STORE(second)
#endif

/* The place for a kill after a last store. Waits come behind it and need none of their own: who is
 * killed while it waits has done nothing since. (Who waits is then really stuck when nobody can go
 * on, and spin reports it.) */
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

/* With CANDIDATES two processes want each role, each again and again: a double start, and a set
 * that is started while the old one dies. Rule 4: the lock, which only death (or the end) drops. */
#ifdef CANDIDATES
byte holder[2] = NONE;
#if defined(NO_LOCK)
#define TAKE  skip
#define LEAVE skip
#elif defined(REPLACED_ON_SILENCE)
/* The role as a lease: whoever finds its holder silent takes over, and any process may be silent. */
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

/* Who is dead; kept for its witness alone. */
#if WITNESS == ALL_DEAD
byte dead_ones;
#define DIES   dead_ones++; assert(dead_ones < 2 || writing == commit || moved == commit)
#define COMES  dead_ones--
#else
#define DIES   skip
#define COMES  skip
#endif
