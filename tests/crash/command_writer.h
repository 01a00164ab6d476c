/* A process that writes commands into a ring: it pauses a world, lets it do a few things, and ends
 * it. It writes each command when the previous one is done and the world is paused, so that each is
 * applied in the same frame in every run. */
#ifndef JOLON_TESTS_CRASH_COMMAND_WRITER_H
#define JOLON_TESTS_CRASH_COMMAND_WRITER_H

/* Runs the process and returns its exit code. When the process is restarted it repeats its list;
 * commands that the ring already holds are not taken twice. */
int command_writer_main(const char *world);

#endif
