/* Draws models for their makers: each kind close up, from the front and from behind, at each level
 * of damage with dents, as a wreck, and at each level of detail at the size from which it is drawn.
 * A kind has one row, or three when it is drawn alone. */
#include "tests/bench/bench.h"
#include "tests/bench/scene.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "renderer/image/png.h"
#include "world/terrain/fixed.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>

#define KINDS_MAX     64u
#define AWAY          25500.0 /* [m] x and z of an empty place */
#define ALONE_PER_ROW 3u      /* pictures when one kind is drawn alone */
#define LEVELS_SEEN   3u      /* levels of detail in one picture */

enum { BEFORE, BEHIND, LOW, MED, HIGH, WRECK, SMALL, COLUMNS };

static uint32_t per_row(const struct bench_options *options)
{
    return options->kind != NULL ? ALONE_PER_ROW : COLUMNS;
}

/* Makes two dents on the right of the front and on the left side. They are deeper at higher damage.
 */
static void bend(struct bench_scene *s, const struct mesh_skeleton *skeleton, enum damage damage)
{
    static const float depth_m[DAMAGE_COUNT] = {0.0f, 0.08f, 0.2f, 0.4f, 0.5f};
    const float *low = skeleton->low, *high = skeleton->high;
    struct dent *dent = s->view.w[0].dents;
    float up = low[1] + 0.45f * (high[1] - low[1]);
    dent[0] = (struct dent){.id = 1,
                            .point = {high[0] * 0.95f, up, high[2] * 0.6f},
                            .direction = {-0.8f, 0.0f, -0.6f},
                            .plastic_m = depth_m[damage]};
    dent[1] = (struct dent){.id = 1,
                            .point = {0.2f * high[0], up, low[2]},
                            .direction = {0.0f, 0.0f, 1.0f},
                            .plastic_m = 0.7f * depth_m[damage]};
    dent_index_update(&s->dents, 0);
    dent_index_update(&s->dents, damage == DAMAGE_NONE ? 0 : 2);
}

static uint32_t fixed_of(const struct world *world, uint32_t kind)
{
    uint32_t i = 0;
    while (i < world->counts.fixed && world->fixed[i].kind != kind)
        i++;
    return i;
}

/* Places the kind for the picture and returns its centre. */
static struct vec3 put(struct bench_scene *s, uint32_t kind_index, uint32_t column)
{
    static const uint8_t damages[COLUMNS] = {
        [LOW] = DAMAGE_LOW, [MED] = DAMAGE_MED, [HIGH] = DAMAGE_HIGH, [WRECK] = DAMAGE_DESTROYED};
    const struct world *world = &s->view.world;
    const struct kind *kind = &world->kinds[kind_index];
    const struct mesh_skeleton *skeleton = &s->static_scene.skeletons[kind->model];
    const struct state *state = &s->view.w[0];
    const struct entities *e = &state->entities;
    double middle = 0.5 * (double)(skeleton->low[1] + skeleton->high[1]);
    for (uint32_t row = 0; row < state->head->used; row++)
        e->row[row].state = ENTITY_FREE;
    if (kind->domain == DOMAIN_FIXED) {
        uint32_t i = fixed_of(world, kind_index);
        if (i == world->counts.fixed)
            die_refused("none of %s is on parade", kind->name);
        state->fixed_damage[i] = damages[column] < DAMAGE_HIGH ? damages[column] : DAMAGE_HIGH;
        return vec3_add(fixed_position(&world->fixed[i]), (struct vec3){0.0, middle, 0.0});
    }
    bool stands = kind->domain == DOMAIN_LAND;
    e->row[0].id = 1;
    e->row[0].state = column == WRECK ? ENTITY_WRECK : ENTITY_ACTIVE;
    e->row[0].kind = (uint16_t)kind_index;
    e->row[0].force = column == BEHIND || column == MED ? FORCE_RED
                      : column == SMALL                 ? FORCE_NEUTRAL
                                                        : FORCE_BLUE;
    e->row[0].damage = damages[column];
    e->row[0].behaviour = BEHAVIOUR_HOLD;
    e->row[0].x = AWAY;
    e->row[0].z = AWAY;
    e->row[0].y = terrain_base_height(&world->terrain, AWAY, AWAY) +
                  (stands ? 0.0 : 1.0 - (double)skeleton->low[1]);
    e->row[0].heading = e->row[0].pitch = e->row[0].roll = 0.0;
    bend(s, skeleton, (enum damage)damages[column]);
    struct frame_view frame_view = bench_scene_frame_view(s);
    articulation_note(&s->articulation, &frame_view);
    return (struct vec3){AWAY, e->row[0].y + middle, AWAY};
}

static double size_of(const struct mesh_skeleton *skeleton)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < 3; i++) {
        double side = (double)skeleton->high[i] - (double)skeleton->low[i];
        sum += side * side;
    }
    return sqrt(sum);
}

static void draw(struct bench_scene *s, struct image *sheet, const struct bench_options *options,
                 uint32_t kind, uint32_t column, uint32_t row)
{
    static const double rotates[COLUMNS] = {[BEFORE] = -0.65, [BEHIND] = 4.2, [LOW] = -0.65,
                                            [MED] = -0.65,    [HIGH] = -0.65, [WRECK] = -0.65};
    struct vec3 middle = put(s, kind, column);
    const struct mesh_skeleton *skeleton =
        &s->static_scene.skeletons[s->view.world.kinds[kind].model];
    double size =
        maths_max(size_of(skeleton), 1.7 * (double)(skeleton->high[1] - skeleton->low[1]));
    uint32_t small = column == SMALL ? LEVELS_SEEN : 1;
    uint32_t down = row + column / per_row(options);
    for (uint32_t i = 0; i < small; i++) {
        struct camera camera;
        bool lies = column >= HIGH && s->view.world.kinds[kind].domain == DOMAIN_FIXED;
        double away = (column == SMALL ? 2.9 + 7.0 * i * i : lies ? 1.7 : 1.05) * size + 0.4;
        double turn = rotates[column] - (column == SMALL ? 0.65 : 0.0);
        struct vec3 from = {sin(turn) * away, 0.33 * away, -cos(turn) * away};
        camera_look(&camera, vec3_add(middle, from), middle, options->size.width,
                    options->size.height);
        struct frame_view frame_view = bench_scene_frame_view(s);
        scene_build(&s->list, &camera, &s->static_scene, &frame_view, &s->effects);
        if (column == WRECK)
            s->list.particle_count = 0; /* its smoke would hide it */
        bench_scene_draw(s, &frame_view);
        struct image part = s->image;
        part.height /= small;
        part.pixels +=
            (size_t)4 * part.width * (s->image.height - part.height) / 2 / part.width * part.width;
        image_copy(sheet, &part, (int32_t)(column % per_row(options) * options->size.width),
                   (int32_t)(down * options->size.height + i * part.height));
    }
}

/* Fills in the kinds to draw and returns their number. */
static uint32_t choose(const struct world *world, const char *name, uint32_t kinds[KINDS_MAX])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < world->counts.kinds && count < KINDS_MAX; i++)
        if (name == NULL || strcmp(name, world->kinds[i].name) == 0)
            kinds[count++] = i;
    if (count == 0)
        die_refused("%s: no such kind", name);
    return count;
}

int bench_models(struct bench_options options)
{
    static struct bench_scene scene;
    struct image sheet;
    uint32_t kinds[KINDS_MAX];
    if (!options.file)
        die_usage("models: needs one FILE; see jolon-bench models --help");
    struct bench_scene_options scene_options = {.scenario = "parade",
                                                .width = options.size.width,
                                                .height = options.size.height,
                                                .threads = 1,
                                                .soft = !options.gl};
    bench_scene_open(&scene, &scene_options);
    uint32_t count = choose(&scene.view.world, options.kind, kinds);
    uint32_t rows = options.kind != NULL ? COLUMNS / ALONE_PER_ROW + 1 : count;
    if (image_init(&sheet, per_row(&options) * options.size.width, rows * options.size.height) != 0)
        die_refused("cannot begin: %s", strerror(errno));
    for (uint32_t row = 0; row < count; row++)
        for (uint32_t column = 0; column < COLUMNS; column++)
            draw(&scene, &sheet, &options, kinds[row], column, row);
    if (png_write_file(AT_FDCWD, options.file, &sheet, "jolon-bench models") != 0)
        die_refused("%s: %s", options.file, strerror(errno));
    image_free(&sheet);
    bench_scene_close(&scene);
    return EXIT_OK;
}
