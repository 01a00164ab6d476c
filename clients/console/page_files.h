/* The page's files, compiled in from clients/console/page/ by clients/console/embed. */
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

/* Returns the file of a request's path, "/" being index.html, or NULL. */
const struct page_files_file *page_files_find(const char *path);

/* Returns the file's media type, by its ending. */
const char *page_files_type(const struct page_files_file *file);

#endif
