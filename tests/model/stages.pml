/* The two stages: ipc/frame/frame_protocol.c, and the places that the steps of mover/ and collider/
 * read and write. */

/* --- doorbells (rule 7) ---------------------------------------------------------------------------*/

#ifdef DOORBELLS
byte bell[2];

#ifdef TOKENS
/* Mutant: the semaphore is a token, taken before the work and given after it. */
#define RING(whose)  STORE(bell[whose]++)
#define AWAIT(ready) bell[role] > 0; STORE(bell[role]--)
#else
#define RING(whose)                                                                                \
    STORE(if :: bell[whose] == 0 -> bell[whose] = 1 :: else fi)
#ifdef NO_TIMEOUT
#define TIMEOUT false
#else
#define TIMEOUT true
#endif
/* Tests the condition, and waits for the bell or the time-out before it tests again. */
#define AWAIT(ready)                                                                               \
    do                                                                                             \
    :: ready -> break                                                                              \
    :: else ->                                                                                     \
       if                                                                                          \
       :: bell[role] > 0 -> bell[role] = 0                                                         \
       :: TIMEOUT -> atomic { if :: ready && bell[role] == 0 -> SEEN(BELL_LOST) :: else fi }       \
       fi                                                                                          \
    od
#endif

#else
/* A bounded wait that tests its condition again is the same as a wait for the condition. */
#define RING(whose)  skip
#define AWAIT(ready) (ready)
#endif

/* --- mover --------------------------------------------------------------------------------------*/

proctype mover(byte self)
{
    byte role = MOVER;
    byte f, a, b;
#ifdef COMMANDS
    byte next, end, key, done;
#endif
born:
    TAKE;
#ifdef TOKENS
    do
    :: commit == FRAMES -> break
    :: else ->
       AWAIT(true);
       f = commit;
       if :: f == FRAMES -> break :: else fi;
#else
    do
    :: MORTAL;
       f = commit;
       assert(moved == f || moved == f + 1);
       if
       :: FINISHED(f) -> break
       :: !FINISHED(f) && moved == f + 1 -> /* rule 3: the collider reads M */
          AWAIT(commit != f);
          goto again
       :: else
       fi;
#endif
#ifdef COMMANDS
#ifdef CURSOR_OUTSIDE
       next = cursor_word;
#else
       next = cursor[f & 1];
#endif
       done = applied[f & 1];
       AWAIT(command_head > next); /* rule 11: a paused world makes a frame for commands */
       end = command_head;
#if CURSOR_OUTSIDE == 1
       STORE(cursor_word = end);
#endif
       do
       :: next < end ->
          key = command_a[next % COMMAND_SLOTS];
          assert(key == command_b[next % COMMAND_SLOTS]); /* untorn */
          assert(key >= 1 && key <= COMMANDS && !(done & BIT(key))); /* applied once */
          atomic { done = done | BIT(key); key = 0; next++ }
       :: else -> break
       od;
#endif
       a = world_a[f & 1];
       b = world_b[f & 1];
       assert(a == WORLD(f) && b == WORLD(f));
       STORE_BOTH(moved_a = TORN, moved_b = TORN);
       STORE_BOTH(moved_a = a + 1, moved_b = b + 1);
#ifdef COMMANDS
       STORE_BOTH(moved_cursor = next, moved_applied = done);
#endif
       STORE(moved = f + 1);
#if CURSOR_OUTSIDE == 2
       STORE(cursor_word = next);
#endif
       RING(COLLIDER);
again:
       atomic {
           f = 0; a = 0; b = 0;
#ifdef COMMANDS
           next = 0; end = 0; done = 0;
#endif
       }
    od;
    atomic { LEAVE; goto ended }
dead:
    atomic {
        f = 0; a = 0; b = 0;
#ifdef COMMANDS
        next = 0; end = 0; key = 0; done = 0;
#endif
        LEAVE; DIES
    }
    atomic { COMES; goto born }
ended:
    skip
}

/* --- collider -----------------------------------------------------------------------------------*/

#define BACK ((f + 1) & 1)

proctype collider(byte self)
{
    byte role = COLLIDER;
    byte f, a, b;
#if defined(EVENTS) || defined(CRATERS)
    byte end, i;
#endif
born:
    TAKE;
#ifdef TOKENS
    do
    :: commit == FRAMES -> break
    :: else ->
       AWAIT(true);
       f = commit;
#else
    do
    :: MORTAL;
       f = commit;
       AWAIT(moved == f + 1 || FINISHED(f));
       if
       :: moved == f + 1
       :: moved != f + 1 -> assert(moved == f); break
       fi;
#endif
       if :: writing == f + 1 -> SEEN(FRAME_AGAIN) :: else fi;
#ifndef NO_WRITING_WORD
       STORE(writing = f + 1); /* rule 6 */
#endif
#ifdef ANSWER_IN_PLACE
       STORE(moved_a = moved_a + 1);
       STORE(moved_b = moved_b + 1);
       a = moved_a;
       b = moved_b;
#else
       a = moved_a;
       b = moved_b;
       atomic {
           assert(a == MOVED(f + 1) && b == MOVED(f + 1)); /* rule 3 */
           a++;
           b++
       };
#endif
       STORE_BOTH(world_a[BACK] = TORN, world_b[BACK] = TORN);
#ifdef CRATERS
#ifdef CRATER_COUNT_OUTSIDE
       end = crater_count_word;
#else
       end = crater_count[f & 1];
#endif
       if
       :: CRATERS_OF(f + 1) == 1 ->
          STORE(crater[end] = CRATERS_UNTIL(f + 1));
          end++
       :: else
       fi;
#ifdef CRATER_COUNT_OUTSIDE
       STORE(crater_count_word = end);
#else
       STORE(crater_count[BACK] = end);
#endif
       end = 0;
#endif
#ifdef EVENTS
#ifdef EVENT_END_OUTSIDE
       end = event_end_word;
#else
       end = event_end[f & 1];
#endif
       do
       :: i < EVENTS_OF(f + 1) ->
          STORE(event_a[end % EVENT_SLOTS] = EVENTS_UNTIL(f) + i + 1);
          STORE(event_b[end % EVENT_SLOTS] = EVENTS_UNTIL(f) + i + 1);
          atomic {
              if :: end >= EVENT_SLOTS -> SEEN(EVENTS_WRAP) :: else fi;
              end++;
              i++
          }
       :: else -> break
       od;
#ifdef EVENT_END_OUTSIDE
       STORE(event_end_word = end);
#else
       STORE(event_end[BACK] = end);
#endif
       atomic { end = 0; i = 0 };
#endif
#ifdef COMMANDS
       STORE_BOTH(cursor[BACK] = moved_cursor, applied[BACK] = moved_applied);
#endif
#ifdef EARLY_COMMIT
       STORE(world_a[BACK] = a);
       STORE(commit = f + 1);
       STORE(world_b[BACK] = b);
#else
       STORE_BOTH(world_a[BACK] = a, world_b[BACK] = b);
       STORE(commit = f + 1);
#endif
       RING(MOVER);
       atomic { f = 0; a = 0; b = 0 }
    od;
    atomic { LEAVE; goto ended }
dead:
    atomic {
        f = 0; a = 0; b = 0;
#if defined(EVENTS) || defined(CRATERS)
        end = 0; i = 0;
#endif
        LEAVE; DIES
    }
    atomic { COMES; goto born }
ended:
    skip
}
