/* storm: kills and stops the processes of a real set at random and checks the consequences. */
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

#define RECOVERY_WAIT_NS ((uint64_t)20 * NS_PER_S)
#define COUNT_EVERY      250 /* strikes between two counts of the descriptors */

uint64_t prng_next(struct prng *prng)
{
    prng->state += 0x9e3779b97f4a7c15u;
    return random_mix(prng->state);
}

double prng_unit(struct prng *prng)
{
    return (double)(prng_next(prng) >> 11) * 0x1.0p-53;
}

uint64_t prng_below(struct prng *prng, uint64_t end)
{
    return prng_next(prng) % end;
}

/* --- options -----------------------------------------------------------------------------------*/

static const char usage[] =
    "[--kills N] [--seed N] [--gap-ms X] [--scenario FILE] [--commands N]\n"
    "             [--renderer] [--world NAME] [--out DIR] [--json]\n"
    "  Kills, stops and continues the processes of a set of its own at random; see\n"
    "  tests/storm/README.md. JOLON_HANG_MS is the keeper's hang limit, as for jolon.";

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
    /* A path that exists is a file. Any other text names a shipped scenario. */
    char *path = realpath(options->scenario, NULL);
    if (path)
        options->scenario = path; /* never freed */
}

/* --- the storm ---------------------------------------------------------------------------------*/

struct storm {
    struct storm_options options;
    struct tested_set set;
    struct recovery_monitor monitor;
    struct invariant_monitor invariants;
    struct fault_injector injector;
    struct sender *sender;
    struct consistency consistency;
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
    if (tested_set_start(&storm->set, &storm->options, &error) != 0)
        die_refused("%s", error.text);
    if (recovery_monitor_start(&storm->monitor, &storm->set.view) != 0 ||
        invariant_monitor_start(&storm->invariants, &storm->set, storm->options.seed) != 0) {
        int because = errno;
        (void)tested_set_stop(&storm->set);
        die_refused("cannot start a thread: %s", strerror(because));
    }
    fault_injector_begin(&storm->injector, &storm->set, &storm->monitor, storm->options.seed);
    if (storm->options.commands > 0) {
        storm->sender = sender_start(&storm->options, &error);
        if (!storm->sender) {
            (void)tested_set_stop(&storm->set);
            die_refused("%s", error.text);
        }
    }
}

static bool count_when_ready(struct storm *storm)
{
    if (tested_set_wait_ready(&storm->set, &storm->injector.error) != 0)
        return false;
    if (!recovery_monitor_wait(&storm->monitor, clock_now_ns() + RECOVERY_WAIT_NS)) {
        error_text_set(&storm->injector.error,
                       "all roles are ready, but no frame has come from some that were struck "
                       "within %d s",
                       (int)(RECOVERY_WAIT_NS / NS_PER_S));
        return false;
    }
    tested_set_count_descriptors(&storm->set);
    return true;
}

/* Returns false if the set broke. */
static bool inject_faults(struct storm *storm)
{
    uint64_t counted = 0;
    bool good = count_when_ready(storm);
    while (good && storm->injector.done < storm->options.kills && !process_stopping()) {
        good = fault_injector_round(&storm->injector) == 0;
        fault_injector_gap(&storm->injector);
        if (good && storm->injector.done - counted >= COUNT_EVERY) {
            counted = storm->injector.done;
            good = count_when_ready(storm);
        }
    }
    fault_injector_end(&storm->injector);
    return good && count_when_ready(storm);
}

/* Stops the set and collects the results as far as that is possible. */
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
    recovery_monitor_stop(&storm->monitor);
    invariant_monitor_stop(&storm->invariants);
    outcome->stop_code = tested_set_stop(&storm->set);
    outcome->processes_left = tested_set_processes_left();
    outcome->files_left = tested_set_files_left(&storm->options);
    if (consistency_read_world(&storm->consistency, &storm->set, &error) != 0 ||
        consistency_read_log(&storm->consistency, &storm->options, source, outcome->sent, &error) !=
            0 ||
        consistency_run_reference(&storm->consistency, &storm->options, &error) != 0) {
        fprintf(stderr, "storm: %s\n", error.text);
        outcome->broken = true;
    }
}

static void remove_folder(struct storm *storm)
{
    const char *arguments[] = {"/bin/rm", "-rf", storm->options.out, NULL};
    recovery_monitor_free(&storm->monitor);
    segment_detach(&storm->set.view);
    if (!storm->options.keep && report_good(&storm->outcome))
        (void)tested_set_run(arguments, NULL, 0, 60);
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
    prctl(PR_SET_CHILD_SUBREAPER, 1); /* orphans become our children: see tested_set.h */
    fprintf(stderr, "storm: SEED=%" PRIu64 " KILLS=%" PRIu64 "\n", storm.options.seed,
            storm.options.kills);
    uint64_t begun = clock_now_ns();
    begin(&storm);
    storm.outcome = (struct outcome){.options = &storm.options,
                                     .injector = &storm.injector,
                                     .monitor = &storm.monitor,
                                     .invariants = &storm.invariants,
                                     .set = &storm.set,
                                     .consistency = &storm.consistency};
    if (!inject_faults(&storm)) {
        fprintf(stderr, "storm: %s\n", storm.injector.error.text);
        storm.outcome.broken = true;
    }
    storm.outcome.wall_s = (double)(clock_now_ns() - begun) / 1e9;
    end(&storm);
    (storm.options.json ? report_json : report_table)(&storm.outcome);
    int code = report_good(&storm.outcome) ? EXIT_OK : EXIT_REFUSED;
    remove_folder(&storm);
    fflush(stdout);
    if (storm.sender)
        sender_free(storm.sender);
    return code;
}
