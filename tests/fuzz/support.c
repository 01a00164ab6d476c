/* The folder of the harnesses, and checks of accepted scenarios. */
#include "tests/fuzz/support.h"

#include "ipc/process/log.h"
#include "world/entity/hull.h"
#include "world/entity/kind.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/model.h"
#include "world/runtime/check.h"
#include "world/terrain/gridsquare.h"

#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

/* libconfig 1.5 does not free the last token when it rejects a text. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:strbuf_append\nleak:libconfig_yylex\n";
}

/* --- files -------------------------------------------------------------------------------------*/

#define BODY                                                                                       \
    "model = \"box\"; mass_kg = 1000; radius_m = 1; resistance_j = 1e6; length_m = 2; width_m = "  \
    "2; height_m = 2; "
#define MOVES "max_speed_mps = 20; acceleration_mps2 = 2; turn_rate_dps = 40; fuel_l = 9; "
#define ARMED "munition = \"shell\"; range_m = 2000; reload_s = 1; rounds = 9; "

static const struct {
    const char *name, *text;
} files[] = {
    {"kinds/tank.cfg", "name = \"tank\"; domain = \"land\"; " BODY MOVES ARMED},
    {"kinds/ship.cfg", "name = \"ship\"; domain = \"sea\"; " BODY MOVES},
    {"kinds/jet.cfg", "name = \"jet\"; domain = \"air\"; climb_rate_mps = 9; " BODY MOVES ARMED},
    {"kinds/shell.cfg",
     "name = \"shell\"; domain = \"munition\"; life_s = 9; craters = true; explosive_kg = 2; " BODY
     "max_speed_mps = 900;"},
    {"kinds/tree.cfg", "name = \"tree\"; domain = \"fixed\"; class = \"tree\"; " BODY},
    {"models/box.mtl", "newmtl red\nKd 1 0 0\nnewmtl force\nKd 0 0 1\nnewmtl bare\nKa 1 1 1\n"},
    {"models/box.obj", "mtllib box.mtl\no body\nv 1 0 0\nv -1 0 -1\nv -1 0 1\nv 0 2 0\nusemtl red\n"
                       "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n"},
};
#define FILES (sizeof files / sizeof files[0])

static char folder[PATH_MAX];

/* Also removes the files of a harness. */
static void remove_folder(void)
{
    static const char *const others[] = {"kinds/k.cfg", "models/k.obj", "models/k.mtl",
                                         "models/k.obj.old"};
    char path[PATH_MAX + 32];
    for (size_t i = 0; i < FILES + sizeof others / sizeof others[0]; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, i < FILES ? files[i].name : others[i - FILES]);
        unlink(path);
    }
    snprintf(path, sizeof path, "%s/kinds", folder);
    rmdir(path);
    snprintf(path, sizeof path, "%s/models", folder);
    rmdir(path);
    rmdir(folder);
}

void support_put(const char *name, const void *bytes, size_t size)
{
    char path[PATH_MAX + 32];
    snprintf(path, sizeof path, "%s/%s", support_data_dir(), name);
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0600);
    CHECK(fd >= 0 && write(fd, bytes, size) == (ssize_t)size);
    close(fd);
}

const char *support_data_dir(void)
{
    char path[PATH_MAX + 32];
    if (folder[0] != '\0')
        return folder;
    const char *temporary = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/jolon-fuzz-XXXXXX", temporary ? temporary : "/tmp");
    CHECK(mkdtemp(folder));
    (void)atexit(remove_folder);
    snprintf(path, sizeof path, "%s/kinds", folder);
    CHECK(mkdir(path, 0700) == 0);
    snprintf(path, sizeof path, "%s/models", folder);
    CHECK(mkdir(path, 0700) == 0);
    for (size_t i = 0; i < FILES; i++)
        support_put(files[i].name, files[i].text, strlen(files[i].text));
    return folder;
}

const char *support_file(const void *bytes, size_t size)
{
    static char path[64];
    static int fd = -1;
    if (fd < 0) {
        fd = memfd_create("fuzz", MFD_CLOEXEC);
        CHECK(fd >= 0);
        snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    }
    CHECK(ftruncate(fd, 0) == 0 && pwrite(fd, bytes, size, 0) == (ssize_t)size);
    return path;
}

void support_path(char *path, size_t bytes, const char *name)
{
    CHECK((size_t)snprintf(path, bytes, "%s/%s", support_data_dir(), name) < bytes);
}

/* --- a world -----------------------------------------------------------------------------------*/

static const char battle[] =
    "world = { capacity = 16; }; terrain = { source = \"flat\"; spacing_m = 125.0; };\n"
    "vehicles = ( { kind = \"tank\"; count = 3; force = \"blue\"; fire_at_will = true;\n"
    "  area = [100.0, 100.0, 300.0, 300.0]; },\n"
    "  { kind = \"jet\"; force = \"red\"; at = [200.0, 200.0]; altitude_m = 80.0; } );";

void support_world_of(struct view *view, const char *path)
{
    struct scenario scenario;
    struct world_build built;
    struct error_text error;
    CHECK(loader_scenario(&scenario, support_data_dir(), path, NULL, 0, &error) == 0);
    CHECK(world_build_make(&built, &scenario, &error) == 0);
    struct segment_header header = segment_header_for(&scenario.settings->params, &built.counts);
    CHECK(segment_private(view, &header, &error) == 0);
    segment_fill(view, &built);
    world_build_free(&built);
    scenario_free(&scenario);
}

void support_world(struct view *view)
{
    support_world_of(view, support_file(battle, strlen(battle)));
}

/* --- what must hold ----------------------------------------------------------------------------*/

void support_check_line(const struct error_text *message)
{
    size_t length = strnlen(message->text, sizeof message->text);
    CHECK(length > 0 && length < sizeof message->text);
    for (size_t i = 0; i < length; i++) {
        unsigned char c = (unsigned char)message->text[i];
        CHECK(c >= 0x20 && c != 0x7f);
    }
}

void support_check_message(const struct error_text *message)
{
    support_check_line(message);
    /* The parser's message when it tries to read another file. */
    const char *what = message->text + strcspn(message->text, ":");
    CHECK(*what == ':');
    what += 1 + strspn(what + 1, "0123456789");
    CHECK(strncmp(what, ": cannot open include", strlen(": cannot open include")) != 0);
    CHECK(strncmp(what, ": include file nesting", strlen(": include file nesting")) != 0);
}

static void check_on_map(double x, double z)
{
    CHECK(x >= 0.0 && x <= WORLD_SIDE_DEFAULT_M && z >= 0.0 && z <= WORLD_SIDE_DEFAULT_M);
}

/* Checks that every vertex of the model is inside one of its hulls. */
static void check_held(const struct scenario *s, const struct kind *kind,
                       const struct model_vertex *v)
{
    double least = INFINITY;
    for (uint32_t h = kind->first_hull; h < kind->first_hull + kind->hull_count; h++) {
        const struct hull *hull = &s->hulls[h];
        double most = -INFINITY;
        for (uint32_t p = 0; p < hull->plane_count; p++) {
            const struct hull_plane *plane = &s->hull_planes[hull->first_plane + p];
            double above = plane->normal.x * (double)v->x + plane->normal.y * (double)v->y +
                           plane->normal.z * (double)v->z - plane->offset_m;
            most = above > most ? above : most;
        }
        least = most < least ? most : least;
    }
    CHECK(least <= 1e-4);
}

static void check_kind(const struct scenario *s, const struct kind *kind)
{
    CHECK(memchr(kind->name, '\0', sizeof kind->name));
    CHECK(kind->domain < DOMAIN_COUNT && kind->object_class < OBJECT_CLASS_COUNT);
    CHECK(kind->munition == KIND_NONE || kind->munition < s->kind_count);
    CHECK(kind->model < s->model_count);
    CHECK(isfinite(kind->stiffness_npm) && kind->stiffness_npm > 0.0);
    CHECK(isfinite(kind->bound_m) && isfinite(kind->level_m) && kind->low_m <= kind->high_m);
    CHECK(kind->hull_count > 0 && kind->first_hull + kind->hull_count <= s->hull_count);
    CHECK(kind->outer_hull < s->hull_count);
    const struct model *model = &s->models[kind->model];
    CHECK(model->first_vertex + model->vertex_count <= s->vertex_count);
    CHECK(model->first_triangle + model->triangle_count <= s->triangle_count);
    CHECK(model->solid_vertices <= model->vertex_count);
    CHECK(model->solid_triangles == 0 || model->solid_triangles < model->triangle_count);
    uint32_t held = model->solid_triangles > 0 ? model->solid_vertices : model->vertex_count;
    for (uint32_t i = 0; i < held; i++)
        check_held(s, kind, &s->vertices[model->first_vertex + i]);
    for (uint32_t i = 0; i < model->triangle_count; i++) {
        const struct model_triangle *t = &s->triangles[model->first_triangle + i];
        CHECK(t->part < PART_COUNT && t->joint < MODEL_JOINTS_MAX);
        for (int k = 0; k < 3; k++)
            CHECK(t->vertex[k] < model->vertex_count);
    }
}

static void check_hulls(const struct scenario *s)
{
    for (uint32_t i = 0; i < s->hull_count; i++) {
        const struct hull *hull = &s->hulls[i];
        CHECK(hull->vertex_count >= 4 && hull->vertex_count <= HULL_VERTICES_MAX);
        CHECK(hull->plane_count >= 4);
        CHECK(hull->first_vertex + hull->vertex_count <= s->hull_vertex_count);
        CHECK(hull->first_plane + hull->plane_count <= s->hull_plane_count);
        CHECK(isfinite(hull->radius_m) && hull->radius_m > 0.0);
    }
}

static void check_groups(const struct scenario *s)
{
    uint64_t total = 0;
    for (uint32_t i = 0; i < s->group_count; i++) {
        const struct scenario_group *group = &s->groups[i];
        CHECK(group->kind < s->kind_count && s->kinds[group->kind].domain <= DOMAIN_AIR);
        CHECK(group->count >= 1 && group->area < s->area_count);
        CHECK(group->route == UINT32_MAX || group->route < s->route_count);
        CHECK(group->force < FORCE_COUNT && group->behaviour < BEHAVIOUR_COUNT);
        CHECK(isfinite(group->altitude_m) && isfinite(group->speed_mps));
        CHECK(group->heading_rad >= 0.0 && group->heading_rad <= TWO_PI);
        check_on_map(group->x, group->z);
        total += group->count;
    }
    CHECK(total == s->settings->params.initial_entities && total <= s->settings->params.capacity);
    for (uint32_t i = 0; i < s->route_count; i++)
        CHECK(s->routes[i].count >= 2 &&
              s->routes[i].first + s->routes[i].count <= s->route_point_count);
    for (uint32_t i = 0; i < s->route_point_count; i++)
        check_on_map(s->route_points[i].x, s->route_points[i].z);
}

void support_check_scenario(const struct scenario *s)
{
    CHECK(s->settings->params.capacity >= 16 && s->settings->params.capacity <= CAPACITY_MAX);
    CHECK(s->settings->params.dt_s > 0.0 && s->settings->params.dt_s <= 1.0);
    CHECK(s->settings->params.intents_per_frame <= s->settings->params.events_per_frame / 2);
    for (uint32_t i = 0; i < s->kind_count; i++)
        check_kind(s, &s->kinds[i]);
    check_hulls(s);
    check_groups(s);
    for (uint32_t i = 0; i < s->object_count; i++) {
        const struct scenario_object *object = &s->object_list[i];
        CHECK(object->kind < s->kind_count && s->kinds[object->kind].domain == DOMAIN_FIXED);
        CHECK(object->size == 1.0f);
        check_on_map(object->x, object->z);
    }
    for (uint32_t i = 0; i < s->fire_count; i++) {
        const struct scenario_fire *fire = &s->fires[i];
        CHECK(fire->munition == KIND_NONE || s->kinds[fire->munition].domain == DOMAIN_MUNITION);
        CHECK(fire->at_s >= 0.0 && isfinite(fire->at_s));
        check_on_map(fire->x, fire->z);
    }
}

void support_check_model(struct scenario *scenario, uint16_t model, const struct hulls *hulls)
{
    /* The same limit as in config/kinds.c. */
    struct kind kind = {.model = model,
                        .munition = KIND_NONE,
                        .stiffness_npm = 1.0,
                        .first_hull = hulls->first,
                        .hull_count = hulls->count,
                        .outer_hull = hulls->outer,
                        .bound_m = hulls->bound_m,
                        .level_m = hulls->level_m,
                        .low_m = hulls->low_m,
                        .high_m = hulls->high_m};
    scenario->kinds = &kind;
    scenario->kind_count = 1;
    check_kind(scenario, &kind);
    check_hulls(scenario);
    scenario->kinds = NULL;
    scenario->kind_count = 0;
}
