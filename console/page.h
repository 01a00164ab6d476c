/* The page's files, compiled in from console/page/ by console/embed. */
#ifndef JOLON_CONSOLE_PAGE_H
#define JOLON_CONSOLE_PAGE_H

#include <stddef.h>
#include <stdint.h>

struct page_file {
    const char *name; /* "index.html" */
    const uint8_t *bytes;
    size_t count;
};

extern const struct page_file page_files[];
extern const size_t page_file_count;

/* The file that a path of a request names, "/" being index.html; NULL when there is none. */
const struct page_file *page_find(const char *path);

/* Its media type, by its ending. */
const char *page_type(const struct page_file *file);

#endif
