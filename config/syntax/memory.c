/* Notices failed allocations of C++. */
#include "config/syntax/memory.h"

#include <stddef.h>

typedef void new_handler(void);

/* std::set_new_handler(), by its linker name. */
extern new_handler *set_new_handler(new_handler *handler) __asm__("_ZSt15set_new_handlerPFvvE");

static bool missed;

static void remember(void)
{
    missed = true;
    set_new_handler(NULL); /* makes operator new throw */
}

void memory_watch(void)
{
    missed = false;
    set_new_handler(remember);
}

bool memory_missed(void)
{
    return missed;
}
