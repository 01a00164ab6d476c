/* The writer of a command ring: command_put() of ipc/frame/command_ring.c, and the part of
 * reporter/intake/command_intake.c that prevents a command from being put twice.
 *
 * Clients send their commands in any order and repeat each until it is answered. An answer is an
 * event of the frame that applied the command. Here the committed set of applied commands stands
 * for these events. The history is what the writer keeps of commands and answers. */

byte answered; /* the commands whose clients have the answer */

/* A client repeats a command that is not answered. Repeats of a command that waits in the history
 * are left out, because they change nothing. */
#define REPEATED(key) (!(answered & BIT(key)) && (known & BIT(key) || !(waiting & BIT(key))))
#ifdef NO_HISTORY
/* Repeats are known by the slots of the ring alone. This is enough for a client that waits for each
 * answer, or has fewer unanswered commands than the ring has slots. */
#define COMES_NOW(key) (REPEATED(key) && answered == BIT(key) - 1)
#else
#define COMES_NOW(key) REPEATED(key)
#endif

proctype sender()
{
    byte role = SENDER;
    byte f, taken, key, i, set;
    byte waiting, known; /* the history: unanswered commands, and answers */
    bit no_room, found;
born:
#ifndef NO_HISTORY
    /* Recovery of the history: before the sender takes a command, it reads the answers up to a
     * committed head and the commands of the ring from that head's cursor on. */
    do
    :: f = commit;
       known = applied[f & 1];
       i = cursor[f & 1];
       if
       :: writing < f + 2 -> break
       :: else
       fi
    od;
    do
    :: i < command_head ->
       atomic { waiting = waiting | BIT(command_a[i % COMMAND_SLOTS]); i++ }
    :: else -> break
    od;
    atomic {
#ifdef RING_NOT_NOTED
        waiting = 0;
#endif
#ifdef ANSWERS_NOT_NOTED
        known = 0;
#endif
        f = 0;
        i = 0
    };
#endif
    do
    :: MORTAL;
       if
       :: answered == ALL_COMMANDS -> goto ended
       :: (applied[commit & 1] & ~known) != 0 -> /* events to read */
          HEAD(f, set, applied);
          known = known | set;
          atomic {
              if
              :: answered = answered | set
              :: skip /* the reply is lost, or a dead sender read the events */
              fi;
              f = 0;
              set = 0
          };
          goto next
       /* A client sends a command, for the first time or again. */
       :: COMES_NOW(1) -> key = 1
       :: COMES_NOW(2) -> key = 2
#if COMMANDS > 2
       :: COMES_NOW(3) -> key = 3
#endif
#if COMMANDS > 3
       :: COMES_NOW(4) -> key = 4
#endif
       fi;
       if
       :: known & BIT(key) ->
          atomic { SEEN(ANSWER_KNOWN); answered = answered | BIT(key); key = 0; goto next }
       :: else
       fi;
put:
       HEAD(f, taken, cursor);
       no_room = (command_head - taken >= COMMAND_SLOTS);
       /* While there is room, the next slot does not count as a known command. */
#ifdef NEXT_SLOT_REMEMBERED
       i = COMMAND_SLOTS;
#else
       i = COMMAND_SLOTS - 1 + no_room;
#endif
#ifndef NO_KEYS
       do
       :: i > 0 && i <= command_head ->
          atomic {
              found = found || command_a[(command_head - i) % COMMAND_SLOTS] == key;
              i--
          }
       :: i > command_head -> i--
       :: i == 0 -> break
       od;
#endif
       if
       :: found ->
          atomic { SEEN(COMMAND_KNOWN); waiting = waiting | BIT(key) }
       :: !found && no_room ->
          atomic { SEEN(RING_FULL); f = 0; taken = 0; no_room = 0 };
          (command_head - cursor[commit & 1] < COMMAND_SLOTS); /* the command waits for room */
          goto put
       :: else ->
#ifdef HEAD_BEFORE_SLOT
          STORE(command_head++);
          STORE(command_a[(command_head - 1) % COMMAND_SLOTS] = key);
          STORE(command_b[(command_head - 1) % COMMAND_SLOTS] = key);
#else
          STORE(command_a[command_head % COMMAND_SLOTS] = key);
          STORE(command_b[command_head % COMMAND_SLOTS] = key);
          STORE(command_head++);
#endif
          atomic {
              if :: command_head > COMMAND_SLOTS -> SEEN(COMMANDS_WRAP) :: else fi;
              waiting = waiting | BIT(key)
          }
       fi;
next:
       atomic { f = 0; taken = 0; key = 0; i = 0; no_room = 0; found = 0 }
    od;
dead:
    atomic {
        f = 0; taken = 0; key = 0; i = 0; set = 0; waiting = 0; known = 0; no_room = 0; found = 0
    };
    goto born;
ended:
    skip
}
