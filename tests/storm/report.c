/* Prints the results of a storm. */
#include "tests/storm/report.h"

#include "ipc/json/world_json.h"

#include <inttypes.h>
#include <stdio.h>

static const char *const fault_names[FAULT_COUNT] = {"SIGKILL", "SIGSTOP", "STOP+CONT"};

static uint64_t torn(const struct outcome *outcome)
{
    return outcome->invariants->torn + outcome->invariants->backward + outcome->monitor->backward;
}

static uint64_t leaks(const struct outcome *outcome)
{
    return outcome->invariants->zombies + (uint64_t)outcome->set->descriptors_over +
           (uint64_t)outcome->processes_left + (uint64_t)outcome->files_left;
}

static bool equal(const struct consistency *consistency)
{
    return consistency->compared && consistency->digest == consistency->reference_digest &&
           consistency->event_digest == consistency->reference_event_digest;
}

bool report_good(const struct outcome *outcome)
{
    const struct consistency *consistency = outcome->consistency;
    return !outcome->broken && outcome->injector->done >= outcome->options->kills &&
           torn(outcome) == 0 && consistency->lost == 0 && consistency->repeated == 0 &&
           leaks(outcome) == 0 && equal(consistency) && outcome->stop_code == 0 &&
           outcome->sent == outcome->answered && consistency->commands_lost == 0 &&
           consistency->commands_repeated == 0 && outcome->monitor->faults == 0;
}

static const char *target_name(uint32_t target)
{
    return target == STRUCK_SUPERVISOR ? "supervisor" : role_name((enum role)target);
}

static double frame_ms(const struct outcome *outcome)
{
    return world_dt_s(&outcome->set->view.world) * 1e3;
}

static void print_strikes(const struct outcome *outcome)
{
    const struct fault_injector *injector = outcome->injector;
    printf("%-18s", "struck");
    for (int kind = 0; kind < FAULT_COUNT; kind++)
        printf(" %10s", fault_names[kind]);
    printf("\n");
    for (uint32_t role = 0; role <= STRUCK_SUPERVISOR; role++) {
        uint64_t total = 0;
        for (int kind = 0; kind < FAULT_COUNT; kind++)
            total += injector->struck[role][kind];
        if (total == 0)
            continue;
        printf("  %-16s", target_name(role));
        for (int kind = 0; kind < FAULT_COUNT; kind++)
            printf(" %10" PRIu64, injector->struck[role][kind]);
        printf("\n");
    }
    printf("  in all %" PRIu64 " of %" PRIu64 "; two at once %" PRIu64
           " times; replacements struck at once %" PRIu64 ", %" PRIu64
           " of them before they held the role; stand-bys %" PRIu64 "\n",
           injector->done, outcome->options->kills, injector->pairs, injector->replacements,
           injector->before_role, injector->stand_bys);
}

static void print_recoveries(const struct outcome *outcome)
{
    printf("%-18s %6s %10s %10s %10s   %s\n", "back after [ms]", "n", "p50", "p99", "max",
           "p50 and p99 in frames");
    for (int i = 0; i < RECOVERY_COUNT; i++) {
        struct times *times = &outcome->monitor->recovered[i];
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

static void print_digest(const struct consistency *consistency)
{
    if (!consistency->compared) {
        printf("%-18s nothing to compare %016" PRIx64 " with   <-- WRONG\n", "digest",
               consistency->digest);
        return;
    }
    printf("%-18s %s: %016" PRIx64 " of the world, %016" PRIx64 " of the events\n", "digest",
           equal(consistency) ? "equal" : "NOT EQUAL", consistency->digest,
           consistency->event_digest);
    if (!equal(consistency))
        printf("%-18s undisturbed: %016" PRIx64 " and %016" PRIx64 "   <-- WRONG\n", "",
               consistency->reference_digest, consistency->reference_event_digest);
}

void report_table(const struct outcome *outcome)
{
    const struct consistency *consistency = outcome->consistency;
    const struct invariant_monitor *invariants = outcome->invariants;
    printf("storm on %s, seed %" PRIu64 ": %.1f s, frames %" PRIu64 " to %" PRIu64 "\n",
           outcome->options->scenario, outcome->options->seed, outcome->wall_s,
           outcome->monitor->first_frame, consistency->frame);
    print_strikes(outcome);
    print_recoveries(outcome);
    if (outcome->monitor->faults > 0)
        printf("%-18s %6u   <-- WRONG\n", "not recovered from", outcome->monitor->faults);
    print_count("torn reads", torn(outcome), "snapshots", invariants->snapshots);
    print_count("lost events", consistency->lost, "events", consistency->events);
    print_count("repeated events", consistency->repeated, "events", consistency->events);
    if (outcome->options->commands > 0) {
        print_count("unanswered", outcome->sent - outcome->answered, "commands", outcome->sent);
        print_count("lost commands", consistency->commands_lost, "commands", outcome->sent);
        print_count("done twice", consistency->commands_repeated, "commands", outcome->sent);
    }
    print_digest(consistency);
    printf("%-18s %6" PRIu64 ": %d files, %d descriptors, %" PRIu64 " zombies, %d processes%s\n",
           "leaks", leaks(outcome), outcome->files_left, outcome->set->descriptors_over,
           invariants->zombies, outcome->processes_left, leaks(outcome) == 0 ? "" : "   <-- WRONG");
    if (outcome->set->starts_refused > 0)
        printf("%-18s %6" PRIu64 " refused and tried again\n", "starts",
               outcome->set->starts_refused);
    printf("%s\n", report_good(outcome) ? "good" : "NOT GOOD");
}

static void add_recoveries(cJSON *object, const struct outcome *outcome)
{
    cJSON *all = json_object(object, "recovery_ms");
    for (int i = 0; i < RECOVERY_COUNT; i++) {
        struct times *times = &outcome->monitor->recovered[i];
        cJSON *one = json_object(all, recovery_name((enum recovery)i));
        json_whole(one, "n", times->count);
        json_number(one, "p50", (double)times_quantile(times, 0.5) / 1e6);
        json_number(one, "p99", (double)times_quantile(times, 0.99) / 1e6);
        json_number(one, "max", (double)times_quantile(times, 1.0) / 1e6);
    }
}

void report_json(const struct outcome *outcome)
{
    const struct consistency *consistency = outcome->consistency;
    cJSON *object = cJSON_CreateObject();
    json_bool(object, "good", report_good(outcome));
    json_whole(object, "seed", outcome->options->seed);
    json_text(object, "scenario", outcome->options->scenario);
    json_number(object, "wall_s", outcome->wall_s);
    json_whole(object, "kills", outcome->injector->done);
    cJSON *struck = json_object(object, "struck");
    for (uint32_t role = 0; role <= STRUCK_SUPERVISOR; role++) {
        cJSON *kinds = json_object(struck, target_name(role));
        for (int kind = 0; kind < FAULT_COUNT; kind++)
            json_whole(kinds, fault_names[kind], outcome->injector->struck[role][kind]);
    }
    json_whole(object, "frame", consistency->frame);
    json_whole(object, "snapshots", outcome->invariants->snapshots);
    json_whole(object, "torn", torn(outcome));
    json_whole(object, "events", consistency->events);
    json_whole(object, "lost", consistency->lost);
    json_whole(object, "repeated", consistency->repeated);
    json_whole(object, "commands", outcome->sent);
    json_whole(object, "commands_answered", outcome->answered);
    json_whole(object, "commands_lost", consistency->commands_lost);
    json_whole(object, "commands_repeated", consistency->commands_repeated);
    json_hex(object, "digest", consistency->digest);
    json_hex(object, "event_digest", consistency->event_digest);
    json_bool(object, "digest_equal", equal(consistency));
    json_whole(object, "files_left", (uint64_t)outcome->files_left);
    json_whole(object, "descriptors_over", (uint64_t)outcome->set->descriptors_over);
    json_whole(object, "zombies", outcome->invariants->zombies);
    json_whole(object, "processes_left", (uint64_t)outcome->processes_left);
    json_whole(object, "not_recovered", outcome->monitor->faults);
    add_recoveries(object, outcome);
    json_print(object);
}
