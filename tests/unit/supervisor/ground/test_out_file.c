/* What the maker of ground files may write over: new and old files, but no map that it reads, no
 * folder, no pipe and no device. */
#include "supervisor/ground/out_file.h"

#include "tests/support/fixture.h"
#include "world/runtime/error_text.h"

#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[] = "/tmp/jolon-out-file-XXXXXX";

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) && chdir(folder) == 0 ? 0 : -1;
}

static int remove_folder(void **state)
{
    const char *const names[] = {"map.tif", "old.ground", "link.tif", "pipe"};
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        unlink(names[i]);
    return chdir("/") == 0 && rmdir(folder) == 0 ? 0 : -1;
}

static void put(const char *name)
{
    int fd = open(name, O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
    assert_true(fd >= 0);
    close(fd);
}

static void files_may_be_new_or_old(void **state)
{
    struct error_text error;
    char map[] = "map.tif", missing[] = "missing.tif", *maps[] = {map, missing};
    (void)state;
    put("map.tif");
    put("old.ground");
    assert_int_equal(out_file_check("new.ground", maps, 2, &error), 0);
    assert_int_equal(out_file_check("./old.ground", maps, 2, &error), 0);
    assert_int_equal(out_file_check("old.ground", NULL, 0, &error), 0);
}

static void maps_are_not_replaced(void **state)
{
    struct error_text error;
    char old[] = "old.ground", map[] = "map.tif", *maps[] = {old, map};
    (void)state;
    put("map.tif");
    assert_int_equal(link("map.tif", "link.tif"), 0);
    const char *const names[] = {"map.tif", "./map.tif", "link.tif"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        assert_int_equal(out_file_check(names[i], maps, 2, &error), -1);
        assert_true(strstr(error.text, "is read") != NULL);
        assert_memory_equal(error.text, names[i], strlen(names[i]));
    }
}

static void only_files_are_replaced_and_read(void **state)
{
    struct error_text error;
    char pipe[] = "pipe", *maps[] = {pipe};
    (void)state;
    assert_int_equal(mkfifo("pipe", 0644), 0);
    assert_int_equal(out_file_check("pipe", NULL, 0, &error), -1);
    assert_true(strstr(error.text, "pipe: is a pipe or a device") != NULL);
    assert_int_equal(out_file_check("new.ground", maps, 1, &error), -1);
    assert_true(strstr(error.text, "pipe: is a pipe or a device, which cannot be read") != NULL);
    assert_int_equal(out_file_check("/dev/null", NULL, 0, &error), -1);
    assert_int_equal(out_file_check("../../tmp", NULL, 0, &error), -1);
    assert_true(strstr(error.text, "is a folder") != NULL);
}

static void the_folder_has_to_exist(void **state)
{
    struct error_text error;
    (void)state;
    assert_int_equal(out_file_check("no/x.ground", NULL, 0, &error), -1);
    assert_string_equal(error.text, "no/x.ground: cannot be written: No such file or directory");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_may_be_new_or_old),
        cmocka_unit_test(maps_are_not_replaced),
        cmocka_unit_test(only_files_are_replaced_and_read),
        cmocka_unit_test(the_folder_has_to_exist),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
