/* What every role does at its start and end: signals, dying with its supervisor. */
#ifndef JOLON_IPC_PROCESS_PROCESS_H
#define JOLON_IPC_PROCESS_PROCESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PROCESS_STACK_BYTES (1024u * 1024u) /* roles have been seen to die with 128 KB */

/* Set by SIGTERM, SIGINT and SIGHUP; loops end when it is true. */
bool process_stopping(void);

/* Installs the handlers, process_guard()'s too; SIGPIPE is ignored. */
void process_signals(void);

/* Every program's first step. A stack that is limited to less than PROCESS_STACK_BYTES, which is
 * that of each thread too, ends the process with the reason (exit 1): else it would die in its work
 * like of a fault in it. And when the world's object is made shorter under a process that has it
 * mapped, it says so in one line and ends with exit 1, instead of dying of the bus error without a
 * word. The process that owns the world names the world's files by process_guard_removes(), at most
 * 5: they are removed then, for there is no other clean-up. SIGXFSZ is ignored: a file that would
 * grow too large is an error (EFBIG). */
void process_guard(void);
void process_guard_removes(const char *path);

/* For a process that makes a world, before the world gets its name: a request to stop comes too
 * late from here to the process's end. So whoever stopped it finds a whole world, and is told of
 * it, or nothing. */
void process_hold_stop(void);

/* May a terminal be coloured: is NO_COLOR not set, or empty? */
bool process_colours(void);

/* Closes every descriptor beyond standard error: what a parent left open is not the role's. To be
 * called before any is opened. */
void process_close_inherited(void);

/* Asks the kernel for SIGKILL when the parent dies; ends at once when it is dead already. */
void process_die_with_parent(int parent_pid);

/* State letter of a process as the kernel tells it (R, S, D, T, Z ...); '\0' when it is gone. A
 * child that its parent has not waited for yet is a zombie (Z) and keeps its number. */
char process_state(int pid);

/* Finds config/, from the place of the running program: the build tree's or the installed one. */
int process_data_dir(char *path, size_t bytes);

#endif
