/* The table. */
#include "tests/storm/report.h"

#include "ipc/json/world_json.h"

#include <inttypes.h>
#include <stdio.h>

static const char *const deed_names[DEED_COUNT] = {"SIGKILL", "SIGSTOP", "STOP+CONT"};

static uint64_t torn(const struct outcome *outcome)
{
    return outcome->witness->torn + outcome->witness->back + outcome->watcher->back;
}

static uint64_t leaks(const struct outcome *outcome)
{
    return outcome->witness->zombies + (uint64_t)outcome->band->descriptors_over +
           (uint64_t)outcome->processes_left + (uint64_t)outcome->files_left;
}

static bool equal(const struct accounts *accounts)
{
    return accounts->compared && accounts->digest == accounts->calm_digest &&
           accounts->event_digest == accounts->calm_event_digest;
}

bool report_good(const struct outcome *outcome)
{
    const struct accounts *accounts = outcome->accounts;
    return !outcome->broken && outcome->victims->done >= outcome->options->kills &&
           torn(outcome) == 0 && accounts->lost == 0 && accounts->repeated == 0 &&
           leaks(outcome) == 0 && equal(accounts) && outcome->stop_code == 0 &&
           outcome->sent == outcome->answered && accounts->commands_lost == 0 &&
           accounts->commands_repeated == 0 && outcome->watcher->faults == 0;
}

static const char *victim_name(uint32_t victim)
{
    return victim == STRUCK_SUPERVISOR ? "supervisor" : role_name((enum role)victim);
}

static double frame_ms(const struct outcome *outcome)
{
    return world_dt_s(&outcome->band->view.world) * 1e3;
}

static void print_strikes(const struct outcome *outcome)
{
    const struct victims *victims = outcome->victims;
    printf("%-18s", "struck");
    for (int deed = 0; deed < DEED_COUNT; deed++)
        printf(" %10s", deed_names[deed]);
    printf("\n");
    for (uint32_t role = 0; role <= STRUCK_SUPERVISOR; role++) {
        uint64_t total = 0;
        for (int deed = 0; deed < DEED_COUNT; deed++)
            total += victims->struck[role][deed];
        if (total == 0)
            continue;
        printf("  %-16s", victim_name(role));
        for (int deed = 0; deed < DEED_COUNT; deed++)
            printf(" %10" PRIu64, victims->struck[role][deed]);
        printf("\n");
    }
    printf("  in all %" PRIu64 " of %" PRIu64 "; two at once %" PRIu64
           " times; replacements struck at once %" PRIu64 ", %" PRIu64
           " of them before they held the role; stand-bys %" PRIu64 "\n",
           victims->done, outcome->options->kills, victims->pairs, victims->chased, victims->unborn,
           victims->stand_bys);
}

static void print_recoveries(const struct outcome *outcome)
{
    printf("%-18s %6s %10s %10s %10s   %s\n", "back after [ms]", "n", "p50", "p99", "max",
           "p50 and p99 in frames");
    for (int i = 0; i < RECOVERY_COUNT; i++) {
        struct times *times = &outcome->watcher->recovered[i];
        double p50 = (double)times_quantile(times, 0.5) / 1e6;
        double p99 = (double)times_quantile(times, 0.99) / 1e6;
        if (times->count == 0)
            continue;
        printf("  %-16s %6zu %10.2f %10.2f %10.2f   %6.2f %6.2f\n", recovery_name((enum recovery)i),
               times->count, p50, p99, (double)times_quantile(times, 1.0) / 1e6,
               p50 / frame_ms(outcome), p99 / frame_ms(outcome));
    }
}

static void print_count(const char *name, uint64_t bad, const char *of, uint64_t all)
{
    printf("%-18s %6" PRIu64 " of %" PRIu64 " %s%s\n", name, bad, all, of,
           bad == 0 ? "" : "   <-- WRONG");
}

static void print_digest(const struct accounts *accounts)
{
    if (!accounts->compared) {
        printf("%-18s nothing to compare %016" PRIx64 " with   <-- WRONG\n", "digest",
               accounts->digest);
        return;
    }
    printf("%-18s %s: %016" PRIx64 " of the world, %016" PRIx64 " of the events\n", "digest",
           equal(accounts) ? "equal" : "NOT EQUAL", accounts->digest, accounts->event_digest);
    if (!equal(accounts))
        printf("%-18s undisturbed: %016" PRIx64 " and %016" PRIx64 "   <-- WRONG\n", "",
               accounts->calm_digest, accounts->calm_event_digest);
}

void report_table(const struct outcome *outcome)
{
    const struct accounts *accounts = outcome->accounts;
    const struct witness *witness = outcome->witness;
    printf("storm on %s, seed %" PRIu64 ": %.1f s, frames %" PRIu64 " to %" PRIu64 "\n",
           outcome->options->scenario, outcome->options->seed, outcome->wall_s,
           outcome->watcher->first_frame, accounts->frame);
    print_strikes(outcome);
    print_recoveries(outcome);
    if (outcome->watcher->faults > 0)
        printf("%-18s %6u   <-- WRONG\n", "not recovered from", outcome->watcher->faults);
    print_count("torn reads", torn(outcome), "snapshots", witness->snapshots);
    print_count("lost events", accounts->lost, "events", accounts->events);
    print_count("repeated events", accounts->repeated, "events", accounts->events);
    if (outcome->options->commands > 0) {
        print_count("unanswered", outcome->sent - outcome->answered, "commands", outcome->sent);
        print_count("lost commands", accounts->commands_lost, "commands", outcome->sent);
        print_count("done twice", accounts->commands_repeated, "commands", outcome->sent);
    }
    print_digest(accounts);
    printf("%-18s %6" PRIu64 ": %d files, %d descriptors, %" PRIu64 " zombies, %d processes%s\n",
           "leaks", leaks(outcome), outcome->files_left, outcome->band->descriptors_over,
           witness->zombies, outcome->processes_left, leaks(outcome) == 0 ? "" : "   <-- WRONG");
    if (outcome->band->starts_refused > 0)
        printf("%-18s %6" PRIu64 " refused and tried again\n", "starts",
               outcome->band->starts_refused);
    printf("%s\n", report_good(outcome) ? "good" : "NOT GOOD");
}

static void add_recoveries(cJSON *object, const struct outcome *outcome)
{
    cJSON *all = json_object(object, "recovery_ms");
    for (int i = 0; i < RECOVERY_COUNT; i++) {
        struct times *times = &outcome->watcher->recovered[i];
        cJSON *one = json_object(all, recovery_name((enum recovery)i));
        json_whole(one, "n", times->count);
        json_number(one, "p50", (double)times_quantile(times, 0.5) / 1e6);
        json_number(one, "p99", (double)times_quantile(times, 0.99) / 1e6);
        json_number(one, "max", (double)times_quantile(times, 1.0) / 1e6);
    }
}

void report_json(const struct outcome *outcome)
{
    const struct accounts *accounts = outcome->accounts;
    cJSON *object = cJSON_CreateObject();
    json_bool(object, "good", report_good(outcome));
    json_whole(object, "seed", outcome->options->seed);
    json_text(object, "scenario", outcome->options->scenario);
    json_number(object, "wall_s", outcome->wall_s);
    json_whole(object, "kills", outcome->victims->done);
    cJSON *struck = json_object(object, "struck");
    for (uint32_t role = 0; role <= STRUCK_SUPERVISOR; role++) {
        cJSON *deeds = json_object(struck, victim_name(role));
        for (int deed = 0; deed < DEED_COUNT; deed++)
            json_whole(deeds, deed_names[deed], outcome->victims->struck[role][deed]);
    }
    json_whole(object, "frame", accounts->frame);
    json_whole(object, "snapshots", outcome->witness->snapshots);
    json_whole(object, "torn", torn(outcome));
    json_whole(object, "events", accounts->events);
    json_whole(object, "lost", accounts->lost);
    json_whole(object, "repeated", accounts->repeated);
    json_whole(object, "commands", outcome->sent);
    json_whole(object, "commands_answered", outcome->answered);
    json_whole(object, "commands_lost", accounts->commands_lost);
    json_whole(object, "commands_repeated", accounts->commands_repeated);
    json_hex(object, "digest", accounts->digest);
    json_hex(object, "event_digest", accounts->event_digest);
    json_bool(object, "digest_equal", equal(accounts));
    json_whole(object, "files_left", (uint64_t)outcome->files_left);
    json_whole(object, "descriptors_over", (uint64_t)outcome->band->descriptors_over);
    json_whole(object, "zombies", outcome->witness->zombies);
    json_whole(object, "processes_left", (uint64_t)outcome->processes_left);
    json_whole(object, "not_recovered", outcome->watcher->faults);
    add_recoveries(object, outcome);
    json_print(object);
}
