/* The temporary folder: copies of the kinds and a link to the models. */
#include "tests/support/quick_config.h"

#include "config/loader.h"

#include <dirent.h>
#include <ftw.h>
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

struct quick_config quick_config;

void quick_config_write(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");

    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
    assert_int_equal(fclose(file), 0);
}

int quick_config_load(struct scenario *scenario, const char *text, const char *override,
                      struct error_text *error)
{
    quick_config_write(quick_config.scenario_path, text);
    return loader_scenario(scenario, quick_config.data_dir, quick_config.scenario_path, &override,
                           override != NULL, error);
}

/* Copies a kind's file and replaces its model with "tank". */
static void copy_kind(const char *kinds, const char *name)
{
    char from[320], to[400], line[256];

    snprintf(from, sizeof(from), QUICK_CONFIG_SHIPPED "/kinds/%s", name);
    snprintf(to, sizeof(to), "%s/%s", kinds, name);
    FILE *in = fopen(from, "r"), *out = fopen(to, "w");
    assert_true(in != NULL && out != NULL);
    while (fgets(line, sizeof(line), in) != NULL)
        fputs(strncmp(line, "model ", 6) == 0 ? "model = \"tank\";\n" : line, out);
    fclose(in);
    assert_int_equal(fclose(out), 0);
}

int quick_config_make(void **state)
{
    char kinds[96], models[96], *shipped = realpath(QUICK_CONFIG_SHIPPED "/models", NULL);
    struct dirent **entries;
    int count = scandir(QUICK_CONFIG_SHIPPED "/kinds", &entries, NULL, NULL);

    (void)state;
    snprintf(quick_config.folder, sizeof(quick_config.folder), "/tmp/jolon-test-loader-XXXXXX");
    if (mkdtemp(quick_config.folder) == NULL || shipped == NULL || count < 0)
        return -1;
    snprintf(quick_config.scenario_path, sizeof(quick_config.scenario_path), "%s/battle.cfg",
             quick_config.folder);
    snprintf(quick_config.data_dir, sizeof(quick_config.data_dir), "%s/quick", quick_config.folder);
    snprintf(kinds, sizeof(kinds), "%s/kinds", quick_config.data_dir);
    snprintf(models, sizeof(models), "%s/models", quick_config.data_dir);
    if (mkdir(quick_config.data_dir, 0700) != 0 || mkdir(kinds, 0700) != 0 ||
        symlink(shipped, models) != 0)
        return -1;
    for (int i = 0; i < count; i++) {
        if (strstr(entries[i]->d_name, ".cfg") != NULL)
            copy_kind(kinds, entries[i]->d_name);
        free(entries[i]);
    }
    free(entries);
    free(shipped);
    return 0;
}

static int remove_entry(const char *path, const struct stat *status, int type, struct FTW *walk)
{
    (void)status, (void)type, (void)walk;
    return remove(path);
}

int quick_config_remove(void **state)
{
    (void)state;
    return nftw(quick_config.folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}
