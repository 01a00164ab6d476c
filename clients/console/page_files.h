/* The page's files, compiled in from console/page/ by clients/console/embed. */
#ifndef JOLON_CLIENTS_CONSOLE_PAGE_FILES_H
#define JOLON_CLIENTS_CONSOLE_PAGE_FILES_H

#include <stddef.h>
#include <stdint.h>

struct page_files_file {
    const char *name; /* "index.html" */
    const uint8_t *bytes;
    size_t count;
};

extern const struct page_files_file page_files[];
extern const size_t page_file_count;

/* The file that a path of a request names, "/" being index.html; NULL when there is none. */
const struct page_files_file *page_files_find(const char *path);

/* Its media type, by its ending. */
const char *page_files_type(const struct page_files_file *file);

#endif
