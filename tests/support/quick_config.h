/* A throw-away folder for tests of config/: a data folder "quick" with the shipped kinds, all of
 * one shape, because reading every model takes longer than all the rest. Tests run in the source
 * tree's top. */
#ifndef JOLON_TESTS_SUPPORT_QUICK_CONFIG_H
#define JOLON_TESTS_SUPPORT_QUICK_CONFIG_H

#define QUICK_CONFIG_SHIPPED "config"

struct quick_config {
    char folder[64];        /* for whatever the test writes */
    char data_dir[80];      /* folder/quick, for loader_scenario() */
    char scenario_path[96]; /* folder/battle.cfg, not yet there */
};

extern struct quick_config quick_config;

/* Group set-up and tear-down for cmocka: makes and removes quick_config.folder. */
int quick_config_make(void **state);
int quick_config_remove(void **state);

/* Writes a whole file; fails the test when it cannot. */
void quick_config_write(const char *path, const char *text);

#endif
