/* The frame words in a weak memory. Spin's own memory is sequentially consistent. So here stores
 * go into a buffer that the memory empties in any order, and loads may be made early. Fences,
 * releases and acquires forbid their reorderings, and each switch removes one of them.
 *
 * A release waits until the buffer is empty, so that no process sees a later store before an
 * earlier one. The buffer of a dead process is emptied before its successor starts, because the
 * successor waits for its death. Each word has one pending store, so two stores to one word keep
 * their order. Loads after an acquire are made in their order; without it, each may have been made
 * before. */

#ifndef FRAMES
#define FRAMES 4
#endif
#define NONE 255

/* --- memory -------------------------------------------------------------------------------------*/

/* The words, grouped by their writers. */
#define COMMIT  0
#define WRITING 1
#define WORLD   2 /* two buffers of two cells */
#define EVENT   6 /* two slots, one event a frame */
#define MOVED   8
#define TABLE   9 /* M: two cells */
#define HEAD    11
#define SLOT    12 /* two slots of two cells */
#define WORDS   16

byte memory[WORDS];
byte buffer[WORDS];
bit pending[WORDS];

#define COLLIDER_EMPTY                                                                             \
    (!(pending[0] || pending[1] || pending[2] || pending[3] || pending[4] || pending[5] ||         \
       pending[6] || pending[7]))
#define MOVER_EMPTY  (!(pending[8] || pending[9] || pending[10]))
#define SENDER_EMPTY (!(pending[11] || pending[12] || pending[13] || pending[14] || pending[15]))

#define STORE(word, value)                                                                         \
    atomic { !pending[word] -> pending[word] = 1; buffer[word] = value }

/* The memory takes any pending store. */
#define DRAIN(word)                                                                                \
    :: d_step { pending[word] -> memory[word] = buffer[word]; pending[word] = 0; buffer[word] = 0 }

active proctype drain()
{
end:
    do
    DRAIN(0) DRAIN(1) DRAIN(2) DRAIN(3) DRAIN(4) DRAIN(5) DRAIN(6) DRAIN(7)
#ifndef RING
    DRAIN(8) DRAIN(9) DRAIN(10)
#else
    DRAIN(11) DRAIN(12) DRAIN(13) DRAIN(14) DRAIN(15)
#endif
    od
}

#define KILL(dead)                                                                                 \
    if                                                                                             \
    :: skip                                                                                        \
    :: goto dead                                                                                   \
    fi

#ifndef RING

/* --- the stages ---------------------------------------------------------------------------------*/

/* frame_mover_begin(), frame_mover_end(). The moved table of frame f is f in both cells. */
active proctype mover()
{
    byte f;
born:
    MOVER_EMPTY;
    f = memory[MOVED];
    do
    :: f == FRAMES -> break
    :: else ->
       (memory[COMMIT] == f); /* acquire */
       KILL(dead);
       STORE(TABLE, f + 1);
       KILL(dead);
       STORE(TABLE + 1, f + 1);
       KILL(dead);
#ifndef NO_MOVED_RELEASE
       MOVER_EMPTY;
#endif
       STORE(MOVED, f + 1);
       f++
    od;
    goto ended;
dead:
    f = 0;
    goto born;
ended:
    skip
}

/* frame_collider_begin(), frame_collider_end(). The world of frame f is f in both cells. */
active proctype collider()
{
    byte f, a, b;
    bit early;
born:
    COLLIDER_EMPTY;
    f = memory[COMMIT];
    do
    :: f == FRAMES -> break
    :: else ->
#ifdef NO_MOVED_ACQUIRE
       if
       :: b = memory[TABLE + 1]; early = 1
       :: skip
       fi;
#endif
       (memory[MOVED] == f + 1); /* acquire */
       STORE(WRITING, f + 1);
#ifndef NO_WRITING_FENCE
       COLLIDER_EMPTY;
#endif
       a = memory[TABLE];
       if
       :: early
       :: !early -> b = memory[TABLE + 1]
       fi;
       atomic { assert(a == f + 1 && b == f + 1); a = 0; b = 0; early = 0 };
       KILL(dead);
       STORE(EVENT + (f & 1), f + 1);
       STORE(WORLD + 2 * ((f + 1) & 1), f + 1);
       KILL(dead);
       STORE(WORLD + 2 * ((f + 1) & 1) + 1, f + 1);
       KILL(dead);
#ifndef NO_COMMIT_RELEASE
       COLLIDER_EMPTY;
#endif
       STORE(COMMIT, f + 1);
       f++
    od;
    goto ended;
dead:
    f = 0;
    goto born;
ended:
    skip
}

/* --- readers ------------------------------------------------------------------------------------*/

#ifdef SNAPSHOT
/* snapshot_take(). */
active proctype reader()
{
    byte f = NONE, a, b, look;
    byte cell[4];
    bit early, looked;
    do
    :: f == FRAMES -> break
    :: else ->
#ifdef NO_COMMIT_ACQUIRE
       if
       :: cell[0] = memory[WORLD]; cell[2] = memory[WORLD + 2]; early = 1
       :: skip
       fi;
#endif
       (memory[COMMIT] != f);
       f = memory[COMMIT]; /* acquire */
#ifdef NO_READER_FENCE
       if
       :: look = memory[WRITING]; looked = 1
       :: skip
       fi;
#endif
       if
       :: early -> a = cell[2 * (f & 1)]
       :: !early -> a = memory[WORLD + 2 * (f & 1)]
       fi;
       b = memory[WORLD + 2 * (f & 1) + 1];
       if
       :: looked
       :: !looked -> look = memory[WRITING]
       fi;
       atomic {
           assert(look >= f + 2 || (a == f && b == f));
           a = 0; b = 0; look = 0; early = 0; looked = 0; cell[0] = 0; cell[2] = 0
       }
    od
}
#endif

#ifdef WALK
/* events_read() on a ring of two slots. One slot is left free, as a frame has one event at most. So
 * of the events up to f only event f may be read, and it is kept only if f is still committed. */
active proctype consumer()
{
    byte f = NONE, event, again;
    bit looked;
    do
    :: f == FRAMES -> break
    :: else ->
       (memory[COMMIT] != f && memory[COMMIT] > 0);
       f = memory[COMMIT];
#ifdef NO_EVENT_FENCE
       if
       :: again = memory[COMMIT]; looked = 1
       :: skip
       fi;
#endif
       event = memory[EVENT + ((f - 1) & 1)];
       if
       :: looked
       :: !looked -> again = memory[COMMIT]
       fi;
       atomic { assert(again != f || event == f); event = 0; again = 0; looked = 0 }
    od
}
#endif

#else

/* --- a command ring -------------------------------------------------------------------------------*/

/* command_put(): FRAMES commands through two slots of two cells. COMMIT is also the cursor, because
 * each frame takes one command. */
active proctype sender()
{
    byte head;
born:
    SENDER_EMPTY;
    head = memory[HEAD];
    do
    :: head == FRAMES -> break
    :: else ->
       (head - memory[COMMIT] < 2); /* room; acquire */
       STORE(SLOT + 2 * (head & 1), head + 1);
       KILL(dead);
       STORE(SLOT + 2 * (head & 1) + 1, head + 1);
       KILL(dead);
#ifndef NO_HEAD_RELEASE
       SENDER_EMPTY;
#endif
       STORE(HEAD, head + 1);
       head++
    od;
    goto ended;
dead:
    head = 0;
    goto born;
ended:
    skip
}

/* frame_mover_begin() with commands_apply(), and the commit of both stages. */
active proctype taker()
{
    byte f, a, b;
    bit early;
    do
    :: f == FRAMES -> break
    :: else ->
#ifdef NO_HEAD_ACQUIRE
       if
       :: b = memory[SLOT + 2 * (f & 1) + 1]; early = 1
       :: skip
       fi;
#endif
       (memory[HEAD] > f); /* acquire */
       a = memory[SLOT + 2 * (f & 1)];
       if
       :: early
       :: !early -> b = memory[SLOT + 2 * (f & 1) + 1]
       fi;
       atomic { assert(a == f + 1 && b == f + 1); a = 0; b = 0; early = 0 };
       COLLIDER_EMPTY;
       STORE(COMMIT, f + 1);
       f++
    od
}
#endif
