/* A process that writes a command ring: it pauses a world, has it do a few things and ends it. Each
 * command is put when the one before is done and the world stands still, so that the frame of each
 * is the same in every run. */
#ifndef JOLON_TESTS_CRASH_COMMANDER_H
#define JOLON_TESTS_CRASH_COMMANDER_H

/* The whole life of the process; its exit code. Begun again after a death, it goes through its list
 * anew: what the ring holds already is not taken twice. */
int commander_main(const char *world);

#endif
