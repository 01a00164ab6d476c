/* The shared fixture: temporary configuration, a private world, the steps on it. */
#include "tests/support/fixture.h"

#include "config/loader.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/maths/random.h"
#include "world/checksum.h"

#include <dirent.h>
#include <ftw.h>
#include <inttypes.h>
#include <limits.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#define SHAPE "bullet" /* the smallest shipped model */

/* --- the data folder ---------------------------------------------------------------------------*/

static char data_dir[64], shipped_dir[PATH_MAX];
static pid_t data_dir_owner;

static bool holds_kinds(const char *folder)
{
    char kinds[PATH_MAX + 8];
    struct stat status;
    snprintf(kinds, sizeof kinds, "%s/kinds", folder);
    return stat(kinds, &status) == 0 && S_ISDIR(status.st_mode);
}

const char *fixture_shipped_dir(void)
{
    const char *given = getenv("JOLON_DATA");
    if (shipped_dir[0] != '\0')
        return shipped_dir;
    if (given) {
        assert_non_null(realpath(given, shipped_dir));
        return shipped_dir;
    }
    char self[PATH_MAX - 16];
    ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    assert_true(length > 0);
    self[length] = '\0';
    for (char *slash = strrchr(self, '/'); slash; slash = strrchr(self, '/')) {
        *slash = '\0';
        snprintf(shipped_dir, sizeof shipped_dir, "%s/config", self);
        if (holds_kinds(shipped_dir))
            return shipped_dir;
    }
    fail_msg("no folder above the test's program contains config/kinds; set JOLON_DATA to the data "
             "folder");
    return NULL;
}

static int remove_entry(const char *path, const struct stat *status, int type, struct FTW *walk)
{
    (void)status, (void)type, (void)walk;
    return remove(path);
}

/* Forked children inherit the exit handler, but only the test may remove the folder. */
static void remove_data_dir(void)
{
    if (getpid() == data_dir_owner)
        nftw(data_dir, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

static void copy_kind(const char *from_path, const char *to_path)
{
    char line[256];
    FILE *from = fopen(from_path, "r"), *to = fopen(to_path, "w");
    assert_true(from && to);
    while (fgets(line, sizeof line, from))
        fputs(strncmp(line, "model ", 6) == 0 ? "model = \"" SHAPE "\";\n" : line, to);
    fclose(from);
    assert_int_equal(fclose(to), 0);
}

static void copy_kinds(const char *shipped)
{
    char from[PATH_MAX + 300], to[PATH_MAX];
    struct dirent **entries;
    snprintf(from, sizeof from, "%s/kinds", shipped);
    int count = scandir(from, &entries, NULL, NULL);
    assert_true(count > 0);
    for (int i = 0; i < count; i++) {
        if (strstr(entries[i]->d_name, ".cfg")) {
            snprintf(from, sizeof from, "%s/kinds/%s", shipped, entries[i]->d_name);
            snprintf(to, sizeof to, "%s/kinds/%s", data_dir, entries[i]->d_name);
            copy_kind(from, to);
        }
        free(entries[i]);
    }
    free(entries);
}

const char *fixture_data_dir(void)
{
    char path[PATH_MAX + 16], link[PATH_MAX];
    const char *shipped = fixture_shipped_dir();
    if (data_dir[0] != '\0')
        return data_dir;
    snprintf(data_dir, sizeof data_dir, "/tmp/jolon-test-XXXXXX");
    assert_non_null(mkdtemp(data_dir));
    data_dir_owner = getpid();
    atexit(remove_data_dir);
    snprintf(path, sizeof path, "%s/kinds", data_dir);
    assert_int_equal(mkdir(path, 0700), 0);
    snprintf(path, sizeof path, "%s/models", shipped);
    snprintf(link, sizeof link, "%s/models", data_dir);
    assert_int_equal(symlink(path, link), 0);
    copy_kinds(shipped);
    return data_dir;
}

/* --- scenarios and worlds ----------------------------------------------------------------------*/

static const char *unless(const char *text, const char *group, const char *fallback)
{
    return strstr(text, group) ? "" : fallback;
}

void fixture_scenario(struct scenario *scenario, const char *text)
{
    struct error_text error;
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/scenario-XXXXXX", fixture_data_dir());
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    FILE *file = fdopen(fd, "w");
    assert_non_null(file);
    fprintf(file, "%s%s%s%s\n",
            unless(text, "world =", "world = { seed = 1; capacity = 64; cruise = false; };\n"),
            unless(text, "terrain =",
                   "terrain = { source = \"flat\"; height_m = 100.0; spacing_m = 125.0; };\n"),
            unless(text, "collision =", "collision = { shape = \"sphere\"; };\n"), text);
    assert_int_equal(fclose(file), 0);
    const char *folder = strstr(text, "shape = \"model\"") ? fixture_shipped_dir() : data_dir;
    int result = loader_scenario(scenario, folder, path, NULL, 0, &error);
    unlink(path);
    if (result != 0)
        fail_msg("the test's scenario is refused: %s", error.text);
}

void fixture_open(struct fixture *fixture, const char *text)
{
    struct error_text error;
    memset(fixture, 0, sizeof *fixture);
    fixture->scenario = calloc(1, sizeof *fixture->scenario);
    fixture->built = calloc(1, sizeof *fixture->built);
    assert_non_null(fixture->scenario);
    assert_non_null(fixture->built);
    fixture_scenario(fixture->scenario, text);
    if (world_build_make(fixture->built, fixture->scenario, &error) != 0)
        fail_msg("the test's world is refused: %s", error.text);
    struct segment_header header =
        segment_header_for(&fixture->scenario->settings->params, &fixture->built->counts);
    if (segment_private(&fixture->view, &header, &error) != 0)
        fail_msg("%s", error.text);
    segment_fill(&fixture->view, fixture->built);
    if (segment_map_posts(&fixture->view, &error) != 0)
        fail_msg("%s", error.text);
    fixture_threads(fixture, 1);
}

void fixture_threads(struct fixture *fixture, uint32_t threads)
{
    frame_stepper_free(&fixture->stepper);
    assert_int_equal(frame_stepper_init(&fixture->stepper, &fixture->view, threads), 0);
}

void fixture_close(struct fixture *fixture)
{
    frame_stepper_free(&fixture->stepper);
    segment_abandon(&fixture->view);
    world_build_free(fixture->built);
    scenario_free(fixture->scenario);
    free(fixture->built);
    free(fixture->scenario);
}

int fixture_teardown(void **state)
{
    fixture_close(*state);
    return 0;
}

/* --- entities ----------------------------------------------------------------------------------*/

uint16_t fixture_kind(const struct fixture *fixture, const char *name)
{
    const struct world *world = &fixture->view.world;
    uint16_t kind = kind_find(world->kinds, world->counts.kinds, name);
    if (kind == KIND_NONE)
        fail_msg("there is no kind %s", name);
    return kind;
}

static uint64_t committed(const struct fixture *fixture)
{
    return atomic_load(&fixture->view.commit->commit);
}

struct state fixture_state(const struct fixture *fixture)
{
    return fixture->view.w[committed(fixture) & 1];
}

uint32_t fixture_put(struct fixture *fixture, struct fixture_entity entity)
{
    const struct world *world = &fixture->view.world;
    struct state state = fixture_state(fixture);
    struct state_head *head = state.head;
    const struct entities *e = &state.entities;
    uint16_t kind_index = fixture_kind(fixture, entity.kind);
    const struct kind *kind = &world->kinds[kind_index];
    bool round = kind->domain == DOMAIN_MUNITION;
    struct vec3 v = entity.velocity;
    uint32_t row = head->used;
    assert_true(row < e->capacity);
    assert_int_equal(head->next_id, row + 1); /* row i has id i + 1 until the first row is freed */
    entities_clear(e, row);
    entities_set_position(e, row, entity.at);
    entities_set_velocity(e, row, v);
    e->row[row].heading =
        v.x != 0.0 || v.z != 0.0 ? maths_heading(v.x, v.z) : maths_wrap_turn(entity.heading_rad);
    e->row[row].id = row + 1;
    e->row[row].kind = kind_index;
    e->row[row].state = ENTITY_ACTIVE;
    e->row[row].force = (uint8_t)entity.force;
    e->row[row].behaviour = (uint8_t)(entity.behaviour != BEHAVIOUR_IDLE ? entity.behaviour
                                      : round                            ? BEHAVIOUR_FLIGHT
                                                                         : BEHAVIOUR_HOLD);
    e->row[row].order = e->row[row].behaviour;
    e->row[row].goal_x = entity.at.x;
    e->row[row].goal_z = entity.at.z;
    e->row[row].fuel_l = kind->fuel_l;
    e->row[row].rounds = kind->rounds;
    e->row[row].owner_slot = entity.owner_slot;
    e->row[row].owner_id = entity.owner_id;
    e->row[row].born_tick = (uint32_t)head->tick;
    if (round)
        e->row[row].until_tick =
            (uint32_t)(head->tick + (uint64_t)(kind->life_s * world->params->hz));
    head->used++;
    head->next_id++;
    head->alloc_next = head->used;
    *(round ? &head->munitions : &head->vehicles) += 1;
    state_seal(&state, world->counts.fixed);
    return row;
}

/* --- frames ------------------------------------------------------------------------------------*/

void fixture_forget_copies(struct fixture *fixture)
{
    struct frame_stepper *stepper = &fixture->stepper;
    stepper->mover.left = stepper->collider.left[0] = stepper->collider.left[1] = 0;
}

/* The steps update checksums from kept hashes. They must equal the checksums computed from the
 * rows. */
static void check_checksums(const struct fixture *fixture)
{
    const struct view *view = &fixture->view;
    const struct state *now = &view->w[committed(fixture) & 1];
    if (!moved_whole(&view->m))
        fail_msg("frame %" PRIu64 ": the moved table fails its checksum", now->head->frame);
    if (!state_whole(now, view->world.counts.fixed))
        fail_msg("frame %" PRIu64 ": the world fails its checksum", now->head->frame);
}

void fixture_run(struct fixture *fixture, uint32_t frames)
{
    fixture_forget_copies(fixture);
    fixture_continue(fixture, frames);
}

void fixture_continue(struct fixture *fixture, uint32_t frames)
{
    for (uint32_t n = 0; n < frames; n++) {
        frame_stepper_step(&fixture->stepper, NULL);
        check_checksums(fixture);
    }
}

uint64_t fixture_digest(const struct fixture *fixture)
{
    struct state state = fixture_state(fixture);
    return state_digest(&fixture->view.world, &state);
}

static uint64_t oldest_event(const struct fixture *fixture, uint64_t end)
{
    uint64_t slots = fixture->view.header->event_slots;
    return end > slots ? end - slots : 0;
}

static const struct event *event_at(const struct fixture *fixture, uint64_t sequence)
{
    return &fixture->view.events[sequence & (fixture->view.header->event_slots - 1)];
}

uint32_t fixture_event_count(const struct fixture *fixture, enum event_type type)
{
    uint64_t end = fixture_state(fixture).head->event_end;
    uint32_t count = 0;
    for (uint64_t i = oldest_event(fixture, end); i < end; i++)
        count += type == EVENT_NONE || event_at(fixture, i)->type == type;
    return count;
}

const struct event *fixture_event(const struct fixture *fixture, enum event_type type, uint32_t nth)
{
    uint64_t end = fixture_state(fixture).head->event_end;
    for (uint64_t i = oldest_event(fixture, end); i < end; i++) {
        const struct event *event = event_at(fixture, i);
        if ((type == EVENT_NONE || event->type == type) && nth-- == 0)
            return event;
    }
    return NULL;
}

/* --- random tests ------------------------------------------------------------------------------*/

uint64_t fixture_seed(uint64_t fallback)
{
    const char *text = getenv("SEED");
    uint64_t seed = text ? strtoull(text, NULL, 0) : fallback;
    print_message("SEED=%" PRIu64 "\n", seed);
    return seed;
}

uint64_t fixture_random(uint64_t *state)
{
    *state += 0x9e3779b97f4a7c15u;
    return random_mix(*state);
}

double fixture_uniform(uint64_t *state, double low, double high)
{
    return low + (high - low) * ((double)(fixture_random(state) >> 11) * 0x1.0p-53);
}

struct vec3 fixture_direction(uint64_t *state)
{
    for (;;) {
        struct vec3 v = {fixture_uniform(state, -1, 1), fixture_uniform(state, -1, 1),
                         fixture_uniform(state, -1, 1)};
        double length = vec3_length(v);
        if (length > 0.1 && length < 1.0)
            return vec3_scale(v, 1.0 / length);
    }
}

void fixture_roughen(float *posts, uint8_t *cover, uint32_t count, uint64_t *state)
{
    for (uint32_t i = 0; i < count; i++) {
        posts[i] = (float)fixture_uniform(state, -50.0, 1500.0);
        cover[i] = (uint8_t)(fixture_random(state) % COVER_COUNT);
    }
}
