/* Named worlds for tests. */
#include "tests/support/named_world.h"

#include "ipc/segment/segment_attach.h"
#include "tests/support/fixture.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

void named_world_name(char name[SEGMENT_NAME_MAX])
{
    static unsigned made;
    snprintf(name, SEGMENT_NAME_MAX, "test-%d-%u", (int)getpid(), ++made);
}

void named_world_publish(const char *name, const struct scenario *scenario,
                         const struct world_build *built)
{
    struct view view;
    struct error_text error;
    struct segment_header header = segment_header_for(&scenario->settings->params, &built->counts);
    if (segment_begin(&view, name, &header, &error) != 0)
        fail_msg("%s", error.text);
    segment_fill(&view, built);
    if (segment_publish(&view, &error) != 0)
        fail_msg("%s", error.text);
    segment_detach(&view);
}

void named_world_make(char name[SEGMENT_NAME_MAX], const char *scenario_text)
{
    struct fixture f;
    named_world_name(name);
    fixture_open(&f, scenario_text);
    named_world_publish(name, f.scenario, f.built);
    fixture_close(&f);
}

void named_world_paths(struct segment_paths *paths, const char *name)
{
    struct error_text error;
    if (segment_paths(paths, name, &error) != 0)
        fail_msg("%s", error.text);
    assert_string_not_equal(paths->object, "");
}

void named_world_remove(const char *name)
{
    struct error_text error;
    if (segment_remove(name, true, &error) != 0)
        fail_msg("%s", error.text);
}

/* Counts the files of a folder whose names begin with prefix, and removes them if told to. */
static int count_files(const char *folder, const char *prefix, bool remove)
{
    int count = 0;
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        if (strncmp(entry->d_name, prefix, strlen(prefix)) != 0)
            continue;
        count++;
        if (remove)
            unlinkat(dirfd(directory), entry->d_name, 0);
    }
    closedir(directory);
    return count;
}

static int go_through_both(bool remove)
{
    char prefix[64], folder[RUNTIME_FOLDER_MAX];
    struct error_text error;
    if (runtime_folder(folder, &error) != 0)
        fail_msg("%s", error.text);
    snprintf(prefix, sizeof prefix, "test-%d-", (int)getpid());
    int count = count_files(folder, prefix, remove);
    snprintf(prefix, sizeof prefix, "jolon.%u.test-%d-", (unsigned)getuid(), (int)getpid());
    return count + count_files("/dev/shm", prefix, remove);
}

int named_world_leftovers(void)
{
    return go_through_both(false);
}

void named_world_clear(void)
{
    go_through_both(true);
}

int named_world_check_left(void **state)
{
    (void)state;
    int left = named_world_leftovers();
    if (left != 0)
        print_error("%d files of worlds are left\n", left);
    return left == 0 ? 0 : -1;
}
