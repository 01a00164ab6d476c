/* The processes that only read: ipc/frame/snapshot.c, and the recorder with its log. */

/* Copies the frame and one word of a world's head. If the collider overtakes the copy, it is taken
 * again (rule 6). */
#define HEAD(frame, word, from)                                                                    \
    do                                                                                             \
    :: frame = commit;                                                                             \
       word = from[frame & 1];                                                                     \
       if                                                                                          \
       :: writing < frame + 2 -> break                                                             \
       :: else                                                                                     \
       fi                                                                                          \
    od

#ifdef READERS
/* Copies each frame that it sees, and may miss frames. Readers are not killed here, because a
 * killed reader leaves nothing behind. */
proctype reader()
{
    byte f = NONE, a, b, count;
    do
    :: f != NONE && FINISHED(f) -> break
    :: else ->
       (commit != f);
       f = commit;
       a = world_a[f & 1];
#ifdef CRATERS
#ifdef CRATER_COUNT_OUTSIDE
       count = crater_count_word;
#else
       count = crater_count[f & 1];
#endif
#endif
       b = world_b[f & 1];
       atomic {
#ifdef NAIVE_READER
           if :: true
#else
           if :: writing < f + 2
#endif
               -> assert(a == WORLD(f) && b == WORLD(f))
#ifdef CRATERS
               ; assert(count == CRATERS_UNTIL(f))
#endif
           :: else -> SEEN(COPY_REJECTED); count = 0
           fi;
           a = 0;
           b = 0
       };
#ifdef CRATERS
       /* The table itself is read last, because rows below the count never change. */
       do
       :: count > 0 -> atomic { assert(crater[count - 1] == count); count-- }
       :: else -> break
       od
#endif
    od
}
#endif

#ifdef EVENTS
/* The log on disk: complete records, and perhaps a torn one at its end. */
byte log_next;   /* the sequence after that of its last complete record */
byte log_events; /* records of events */
byte log_lost;   /* events that its gap records count */
bit log_torn;
#ifdef LOG_CURSOR_APART
byte log_cursor; /* the next sequence, in a file of its own */
#endif

#ifdef NO_FREE_FRAME
#define EVENTS_KEPT EVENT_SLOTS
#else
#define EVENTS_KEPT (EVENT_SLOTS - EVENTS_A_FRAME)
#endif
#define OLDEST(end) ((end) > EVENTS_KEPT -> (end) - EVENTS_KEPT : 0)
#define BATCH 2

#ifdef EVENT_END_OUTSIDE
#define EVENTS_HEAD f = commit; end = event_end_word
#else
#define EVENTS_HEAD HEAD(f, end, event_end)
#endif

/* Appends a record; a kill in the middle leaves a torn one. */
#define APPEND(record)                                                                             \
    atomic {                                                                                       \
        if                                                                                         \
        :: true -> assert(!log_torn); log_torn = 1                                                 \
        :: KILLED -> goto dead                                                                     \
        fi                                                                                         \
    };                                                                                             \
    atomic {                                                                                       \
        if                                                                                         \
        :: true -> record; log_torn = 0                                                            \
        :: KILLED -> goto dead                                                                     \
        fi                                                                                         \
    }

proctype recorder()
{
    byte role = RECORDER;
    byte f, end, next, gap, count, i;
    byte a[BATCH], b[BATCH];
born:
    atomic {
#ifndef TORN_TAIL_KEPT
        if :: log_torn -> SEEN(TAIL_CUT); log_torn = 0 :: else fi;
#endif
#ifdef LOG_CURSOR_APART
        next = log_cursor
#else
        next = log_next
#endif
    };
    do
    :: MORTAL;
       (log_next < EVENTS_UNTIL(commit) || commit == FRAMES); /* a new frame, or the last one */
       EVENTS_HEAD;
       atomic {
           if
           :: next < OLDEST(end) ->
              SEEN(EVENTS_GAP);
              gap = OLDEST(end) - next;
              next = OLDEST(end)
           :: else
           fi
       };
       do
       :: count < BATCH && next + count < end ->
          a[count] = event_a[(next + count) % EVENT_SLOTS];
          b[count] = event_b[(next + count) % EVENT_SLOTS];
          count++
       :: else -> break
       od;
#ifndef NO_SECOND_LOOK
       EVENTS_HEAD;
#endif
       /* Events that may have been overwritten during the copy are counted as lost. */
       atomic {
           do
           :: next < OLDEST(end) && count > 0 ->
              SEEN(EVENTS_LOST);
              a[0] = a[1]; b[0] = b[1]; a[1] = 0; b[1] = 0;
              gap++;
              next++;
              count--
           :: else -> break
           od
       };
       if
       :: gap > 0 -> APPEND(log_lost = log_lost + gap; log_next = next)
       :: else
       fi;
       do
       :: i < count ->
          assert(a[i] == next + 1 && b[i] == next + 1); /* untorn, in order, once each */
          APPEND(log_events++; log_next = next + 1);
#ifdef LOG_CURSOR_APART
          STORE(log_cursor = next + 1);
#endif
          atomic { a[i] = 0; b[i] = 0; i++; next++ }
       :: else -> break
       od;
       atomic {
           if
           :: commit == FRAMES && count == 0 && gap == 0 && next >= EVENTS_UNTIL(FRAMES) ->
              assert(log_events + log_lost == EVENTS_UNTIL(FRAMES) && log_next == next);
              goto ended
           :: else
           fi;
           f = 0; end = 0; gap = 0; count = 0; i = 0
       }
    od;
dead:
    atomic {
        f = 0; end = 0; next = 0; gap = 0; count = 0; i = 0;
        a[0] = 0; a[1] = 0; b[0] = 0; b[1] = 0
    };
    goto born;
ended:
    skip
}
#endif
