/* storm: kills and stops the processes of a real set at random, and counts what came of it. */
#include "tests/storm/storm.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_attach.h"
#include "tests/storm/report.h"
#include "tests/storm/sender.h"
#include "world/maths/random.h"
#include "world/runtime/parse_number.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#define CALM_NS    ((uint64_t)20 * NS_PER_S)
#define REST_EVERY 250 /* strikes from one rest, at which descriptors are counted, to the next */

uint64_t chance_next(struct chance *chance)
{
    chance->state += 0x9e3779b97f4a7c15u;
    return random_mix(chance->state);
}

double chance_unit(struct chance *chance)
{
    return (double)(chance_next(chance) >> 11) * 0x1.0p-53;
}

uint64_t chance_below(struct chance *chance, uint64_t end)
{
    return chance_next(chance) % end;
}

/* --- options -----------------------------------------------------------------------------------*/

static const char usage[] =
    "[--kills N] [--seed N] [--gap-ms X] [--scenario FILE] [--commands N]\n"
    "             [--renderer] [--world NAME] [--out DIR] [--json]\n"
    "  kills, stops and continues the processes of a set of its own at random; see\n"
    "  tests/storm/README.md. JOLON_HANG_MS is the keeper's limit, as for jolon.";

static void find_programs(char *path, size_t bytes)
{
    const char *given = getenv("JOLON_BIN");
    char self[STORM_PATH_MAX - 128];
    if (given) {
        snprintf(path, bytes, "%s", given);
        return;
    }
    ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    if (length <= 0)
        die_refused("/proc/self/exe: %s", strerror(errno));
    self[length] = '\0';
    for (int i = 0; i < 3; i++) /* BUILD/tests/storm/storm */
        *strrchr(self, '/') = '\0';
    snprintf(path, bytes, "%s/bin", self);
}

static void read_options(struct storm_options *options, int argc, char **argv)
{
    static struct storm_options given = {
        .kills = 1000, .gap_ms = 40.0, .hang_ms = 100.0, .scenario = "tests/storm/crowd.cfg"};
    static const struct option_row rows[] = {
        {"kills", "N", NULL, .u64 = &given.kills, .least = 1, .most = 1000000000},
        {"seed", "N", NULL, .u64 = &given.seed, .most = UINT64_MAX - 1},
        {"gap-ms", "X", NULL, .real = &given.gap_ms, .high = 60000.0},
        {"scenario", "FILE", NULL, .text = &given.scenario},
        {"commands", "N", NULL, .u64 = &given.commands, .most = 1000000},
        {"renderer", NULL, NULL, .flag = &given.renderer},
        {"world", "NAME", NULL, .text = &given.world, .letter = 'w'},
        {"out", "DIR", NULL, .text = &given.out},
        {"json", NULL, NULL, .flag = &given.json},
        OPTION_ROWS_END};
    static const struct option_table table = {.program = "storm", .usage = usage, .rows = rows};
    const char *hang = getenv("JOLON_HANG_MS");
    given.seed = clock_now_ns() % 1000000;
    if (hang && !parse_real(hang, 1.0, 1e6, &given.hang_ms))
        die_usage("JOLON_HANG_MS %s: must be a number from 1 to 1e6", hang);
    option_table_read(&table, argc, argv);
    given.keep = given.out != NULL;
    *options = given;
    /* A file; else it is the name of one that comes with Jolon. */
    char *path = realpath(options->scenario, NULL);
    if (path)
        options->scenario = path; /* for as long as we run */
}

/* --- the storm ---------------------------------------------------------------------------------*/

struct storm {
    struct storm_options options;
    struct band band;
    struct watcher watcher;
    struct witness witness;
    struct victims victims;
    struct sender *sender;
    struct accounts accounts;
    struct outcome outcome;
};

static void begin(struct storm *storm)
{
    static char name[SEGMENT_NAME_MAX], folder[] = "/tmp/jolon-storm-XXXXXX";
    struct error_text error;
    if (!storm->options.world) {
        snprintf(name, sizeof name, "storm-%d", (int)getpid());
        storm->options.world = name;
    }
    if (!storm->options.out)
        storm->options.out = mkdtemp(folder);
    if (!storm->options.out ||
        (storm->options.keep && mkdir(storm->options.out, 0700) != 0 && errno != EEXIST))
        die_refused("%s: cannot make the folder: %s", storm->options.out, strerror(errno));
    if (band_start(&storm->band, &storm->options, &error) != 0)
        die_refused("%s", error.text);
    if (watcher_start(&storm->watcher, &storm->band.view) != 0 ||
        witness_start(&storm->witness, &storm->band, storm->options.seed) != 0)
        die_refused("cannot start a thread: %s", strerror(errno));
    victims_begin(&storm->victims, &storm->band, &storm->watcher, storm->options.seed);
    if (storm->options.commands > 0) {
        storm->sender = sender_start(&storm->options, &error);
        if (!storm->sender)
            die_refused("%s", error.text);
    }
}

static bool count_at_rest(struct storm *storm)
{
    if (!band_rest(&storm->band) || !watcher_calm(&storm->watcher, clock_now_ns() + CALM_NS)) {
        error_text_set(&storm->victims.error, "the set does not come to rest");
        return false;
    }
    band_count_descriptors(&storm->band);
    return true;
}

/* False when the set broke. */
static bool rage(struct storm *storm)
{
    uint64_t rested = 0;
    bool good = count_at_rest(storm);
    while (good && storm->victims.done < storm->options.kills && !process_stopping()) {
        good = victims_round(&storm->victims) == 0;
        victims_gap(&storm->victims);
        if (good && storm->victims.done - rested >= REST_EVERY) {
            rested = storm->victims.done;
            good = count_at_rest(storm);
        }
    }
    victims_end(&storm->victims);
    return good && count_at_rest(storm);
}

/* Ends the set; what is to be found out afterwards is, as far as it goes. */
static void end(struct storm *storm)
{
    struct outcome *outcome = &storm->outcome;
    struct error_text error = {0};
    uint64_t source = 0;
    if (storm->sender) {
        sender_stop(storm->sender);
        source = sender_source(storm->sender);
        outcome->sent = sender_sent(storm->sender);
        outcome->answered = sender_answered(storm->sender);
    }
    watcher_stop(&storm->watcher);
    witness_stop(&storm->witness);
    outcome->stop_code = band_stop(&storm->band);
    outcome->processes_left = band_processes_left();
    outcome->files_left = band_files_left(&storm->options);
    if (accounts_world(&storm->accounts, &storm->band, &error) != 0 ||
        accounts_log(&storm->accounts, &storm->options, source, outcome->sent, &error) != 0 ||
        accounts_calm(&storm->accounts, &storm->options, &error) != 0) {
        fprintf(stderr, "storm: %s\n", error.text);
        outcome->broken = true;
    }
}

static void clean_up(struct storm *storm)
{
    const char *arguments[] = {"/bin/rm", "-rf", storm->options.out, NULL};
    watcher_free(&storm->watcher);
    segment_detach(&storm->band.view);
    if (!storm->options.keep && report_good(&storm->outcome))
        (void)band_run(arguments, NULL, 0, 60);
    else
        fprintf(stderr, "storm: logs are in %s\n", storm->options.out);
}

int main(int argc, char **argv)
{
    static struct storm storm;
    log_open("storm");
    read_options(&storm.options, argc, argv);
    find_programs(storm.options.bin, sizeof storm.options.bin);
    process_signals();
    prctl(PR_SET_CHILD_SUBREAPER, 1); /* who loses its parent becomes our child: see band.h */
    fprintf(stderr, "storm: SEED=%" PRIu64 " KILLS=%" PRIu64 "\n", storm.options.seed,
            storm.options.kills);
    uint64_t begun = clock_now_ns();
    begin(&storm);
    storm.outcome = (struct outcome){.options = &storm.options,
                                     .victims = &storm.victims,
                                     .watcher = &storm.watcher,
                                     .witness = &storm.witness,
                                     .band = &storm.band,
                                     .accounts = &storm.accounts};
    if (!rage(&storm)) {
        fprintf(stderr, "storm: %s\n", storm.victims.error.text);
        storm.outcome.broken = true;
    }
    storm.outcome.wall_s = (double)(clock_now_ns() - begun) / 1e9;
    end(&storm);
    (storm.options.json ? report_json : report_table)(&storm.outcome);
    int code = report_good(&storm.outcome) ? EXIT_OK : EXIT_REFUSED;
    clean_up(&storm);
    fflush(stdout);
    if (storm.sender)
        sender_free(storm.sender);
    return code;
}
