/* A temporary folder for tests of config/, with a data folder "quick". It holds the shipped kinds
 * with one common model, because reading all models takes longer than a test. Tests run in the top
 * folder of the sources. */
#ifndef JOLON_TESTS_SUPPORT_QUICK_CONFIG_H
#define JOLON_TESTS_SUPPORT_QUICK_CONFIG_H

#define QUICK_CONFIG_SHIPPED "config"

struct quick_config {
    char folder[64];        /* for files that the test writes */
    char data_dir[80];      /* folder/quick, for loader_scenario() */
    char scenario_path[96]; /* folder/battle.cfg; the test writes it */
};

extern struct quick_config quick_config;

struct error_text;
struct scenario;

/* Group set-up and tear-down for cmocka: makes and removes quick_config.folder. */
int quick_config_make(void **state);
int quick_config_remove(void **state);

/* Writes the text to quick_config.scenario_path and loads it. override: NULL or one KEY=VALUE.
 * Returns what loader_scenario() does. */
int quick_config_load(struct scenario *scenario, const char *text, const char *override,
                      struct error_text *error);

/* Writes a whole file. Fails the test on an error. */
void quick_config_write(const char *path, const char *text);

#endif
