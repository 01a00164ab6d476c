/* Lets a harness survive code that exits with one line when it refuses something. Linked with
 * --wrap=exit (see the Makefile).
 *
 *     if (ENDING_CATCH() == 0)
 *         may_call_exit();
 *     ending_done();
 */
#ifndef JOLON_TESTS_FUZZ_SHARED_ENDING_H
#define JOLON_TESTS_FUZZ_SHARED_ENDING_H

#include <setjmp.h>

extern jmp_buf ending;

/* Until ending_done() is called, exit() returns here with a value that is not 0. */
#define ENDING_CATCH() (ending_begin(), setjmp(ending))

void ending_begin(void);
void ending_done(void);

#endif
