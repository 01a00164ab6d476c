/* What every process does at its start and end: signals, ending with its parent. */
#ifndef JOLON_IPC_PROCESS_PROCESS_H
#define JOLON_IPC_PROCESS_PROCESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PROCESS_STACK_BYTES (1024u * 1024u) /* a role crashed with 128 KB */

/* Returns true after SIGTERM, SIGINT or SIGHUP. Loops then end. */
bool process_stopping(void);

/* Returns true if such a signal came from the parent that process_begin() has named, or if there is
 * none. The keeper sends it to a role when the run is over. After a signal of anybody else the
 * keeper starts the role again. */
bool process_stopped_by_parent(void);

/* Installs the handlers of these signals and those of process_guard(). SIGPIPE is ignored. */
void process_signals(void);

/* The first step of every program. Ends the process (exit 1) when its stack is limited to less than
 * PROCESS_STACK_BYTES. The limit holds for each thread too, and a stack overflow would look like a
 * crash. When another process makes the world's object shorter, a process that has it mapped ends
 * with one line (exit 1) instead of a bus error. SIGXFSZ is ignored: writing a file that would grow
 * too large fails with EFBIG.
 *
 * process_guard_removes() names a file, at most 5, that is removed when the object was made
 * shorter. The process that owns the world names the world's files, because it cannot clean up
 * otherwise.
 *
 * process_guard_tells() names what is said instead when a page in bytes from `from` is missing,
 * where another file is mapped; the last call counts, and NULL ends it. Main thread. */
void process_guard(void);
void process_guard_removes(const char *path);
void process_guard_tells(const void *from, size_t bytes, const char *text);

/* For a process that makes a world, before the world gets its name. Blocks SIGTERM, SIGINT and
 * SIGHUP until the process ends. The user who stopped the process then finds a whole world, or
 * none. */
void process_hold_stop(void);

/* Returns true if colours may be used on a terminal: NO_COLOR is not set, or empty. */
bool process_colours(void);

/* Closes every descriptor above standard error, which a parent may have left open. To be called
 * before the process opens any. */
void process_close_inherited(void);

/* Asks the kernel for SIGKILL when the parent dies. Ends the process when the parent is dead
 * already. */
void process_die_with_parent(int parent_pid);

/* Lowers the priority of the calling thread, and of the threads that it starts later, to this many
 * steps of niceness below the priority that the process was started with, at most to the lowest.
 * A world started under nice keeps the order of its processes. Returns 0, or -1 with errno. */
int process_lower_priority(int steps);

/* What a role's program does first, when it has read its options: it closes inherited descriptors,
 * takes signals, and asks to end with its parent (0: none). */
void process_begin(int parent_pid);

/* As process_begin(), for a role beside the frames: it lowers its priority, so that it yields to
 * those that make them, and says so in the log when it may not. */
void process_begin_beside(int parent_pid);

/* Returns the state letter of a process from /proc (R, S, D, T, Z ...), '\0' when there is none. A
 * child that its parent has not waited for yet is a zombie (Z) and keeps its pid. */
char process_state(int pid);

/* Returns true when no process has this pid, or when the one that has it is a zombie, which does
 * nothing any more. It tells so also inside a sandbox that forbids signals to that process, where
 * kill() fails with EPERM. */
bool process_has_ended(int pid);

/* Finds config/ from $JOLON_DATA or from the path of the running program, in the build tree or
 * installed. Returns 0, or -1 with errno. */
int process_data_dir(char *path, size_t bytes);

#endif
