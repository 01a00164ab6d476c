/* Children that enter sandboxes, for the tests of sandboxes. They call
 * the sandbox's library, which the Makefile links with the tests in tests/unit/ipc/sandbox/. */
#ifndef JOLON_TESTS_SUPPORT_CONFINED_H
#define JOLON_TESTS_SUPPORT_CONFINED_H

#include <stdbool.h>

#define NOT_ENTERED 77 /* exit code of a child whose sandbox the kernel refused */

extern char confined_output[512]; /* what the last child wrote to standard error */
extern char confined_folder[];    /* the folder of this group of tests */

/* Set-up and tear-down of a group: make the folder, and remove it when it is empty. */
int confined_make_folder(void **state);
int confined_remove_folder(void **state);

/* Returns false in a build whose roles have no sandbox. A sanitized build confines the mover and
 * the collider alone (tests/system/test_heavy.sh). */
bool confined_available(void);

/* Prints that the program's tests are skipped because there is no sandbox. Returns 0. */
int confined_skip(void);

/* Runs a body as child_run() does and stores its standard error in confined_output. Fails the test
 * when the body returns NOT_ENTERED. */
int confined_run(int (*body)(void *context), void *context);

/* Allocates, grows and frees blocks of 1 byte to 64 MB, as a child. */
void confined_use_memory(void);

#endif
