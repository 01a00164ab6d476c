/* The frame protocol under kills. Switches select the parts; README.md lists these. */
#include "words.pml"
#include "stages.pml"
#include "readers.pml"
#ifdef COMMANDS
#include "sender.pml"
#endif

init
{
    atomic {
        run mover(0);
        run collider(0);
#ifdef CANDIDATES
        run mover(1);
        run collider(1);
#endif
#ifdef TOKENS
        bell[MOVER] = 1;
#endif
#ifdef READERS
        run reader();
#if READERS > 1
        run reader();
#endif
#endif
#ifdef EVENTS
        run recorder();
#endif
#ifdef COMMANDS
        run sender()
#endif
    }
}

#ifdef ENDS
/* When kills end, the run comes to its end. */
ltl ends { <> (commit == FRAMES) }
#endif
