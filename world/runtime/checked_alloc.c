/* Allocation failures in libraries: all allocations of the program go through this file, by the
 * linker's --wrap. */
#include "world/runtime/checked_alloc.h"

#include <setjmp.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp): the linker's names */
void *__real_malloc(size_t bytes);
void *__real_calloc(size_t count, size_t bytes);
void *__real_realloc(void *memory, size_t bytes);
char *__real_strdup(const char *text);
void *__wrap_malloc(size_t bytes);
void *__wrap_calloc(size_t count, size_t bytes);
void *__wrap_realloc(void *memory, size_t bytes);
char *__wrap_strdup(const char *text);
char *__wrap___strdup(const char *text);

static _Thread_local jmp_buf way_out;
static _Thread_local volatile bool checked_alloc;

static void *given(void *memory, size_t bytes)
{
    if (!memory && bytes > 0 && checked_alloc)
        longjmp(way_out, 1);
    return memory;
}

void *__wrap_malloc(size_t bytes)
{
    return given(__real_malloc(bytes), bytes);
}

void *__wrap_calloc(size_t count, size_t bytes)
{
    return given(__real_calloc(count, bytes), bytes);
}

void *__wrap_realloc(void *memory, size_t bytes)
{
    return given(__real_realloc(memory, bytes), bytes);
}

char *__wrap_strdup(const char *text)
{
    return given(__real_strdup(text), 1);
}

char *__wrap___strdup(const char *text)
{
    return __wrap_strdup(text);
}
/* NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp) */

bool memory_guarded(void (*function)(void *context), void *context)
{
    bool whole = false;
    if (setjmp(way_out) == 0) {
        checked_alloc = true;
        function(context);
        whole = true;
    }
    checked_alloc = false;
    return whole;
}
