/* Crash points: places between two stores at which a process can be made to die.
 *
 * In a build made by `make CRASHPOINTS=1` every store of the frame protocol, of a world's creation
 * and of the event log has a named point before it. In any other build the macros are nothing. The
 * environment of such a build's programs:
 *
 *     JOLON_CRASH=ROLE:NAME:N[:SIGNAL]
 *                               the process of that role (the name given to log_open()) sends
 *                               itself SIGNAL (a number; default 9, SIGKILL) when it reaches the
 *                               point NAME for the Nth time
 *     JOLON_CRASH_COUNT=FILE    at its end a process appends a line for each of its points: role,
 *                               name and number of crossings, separated by tabs
 * tests/crash kills every role at each of its points. */
#ifndef JOLON_IPC_PROCESS_CRASH_POINT_H
#define JOLON_IPC_PROCESS_CRASH_POINT_H

#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

/* The macros below call these. */
struct crash_point {
    _Alignas(16) const char *name;
    _Atomic uint64_t crossings;
};

void crash_point_role(const char *role);
void crash_point_cross(struct crash_point *point);
void crash_point_guard_stores(void *first, size_t bytes);
void crash_point_guard_pages(void *first, size_t bytes);
void crash_point_unguard(void);

#ifdef CRASHPOINTS

/* The points of a program lie in a section of their own, so that a point that is never reached is
 * counted too. */
#define CRASH_POINT(point_name)                                                                    \
    do {                                                                                           \
        static struct crash_point crash_point                                                      \
            __attribute__((section("crash_points"), used)) = {point_name, 0};                      \
        crash_point_cross(&crash_point);                                                           \
    } while (0)

/* Sets the role of this process. */
#define CRASH_POINT_ROLE(role) crash_point_role(role)

/* How many of the bytes to write at a time, so that a kill can leave half a line. */
#define CRASH_POINT_PART(bytes) ((bytes) > 64 ? (bytes) / 2 : (bytes))

/* Until CRASH_POINT_UNGUARD every store of this thread to the pages from first on crosses the point
 * "store in a step" (STORES), or the first store to each page crosses "page of a new world"
 * (PAGES). For code that must not know of crash points. */
#define CRASH_POINT_GUARD_STORES(first, bytes) crash_point_guard_stores(first, bytes)
#define CRASH_POINT_GUARD_PAGES(first, bytes)  crash_point_guard_pages(first, bytes)
#define CRASH_POINT_UNGUARD()                  crash_point_unguard()

#else

#define CRASH_POINT(name)                      ((void)0)
#define CRASH_POINT_ROLE(role)                 ((void)0)
#define CRASH_POINT_PART(bytes)                (bytes)
#define CRASH_POINT_GUARD_STORES(first, bytes) ((void)0)
#define CRASH_POINT_GUARD_PAGES(first, bytes)  ((void)0)
#define CRASH_POINT_UNGUARD()                  ((void)0)

#endif

#endif
