/* The software back end: drawing one picture, opening and closing. */
#include "renderer/soft/soft.h"

#include "renderer/soft/fxaa.h"
#include "renderer/scene/frame/light.h"
#include "renderer/soft/kernel.h"
#include "renderer/soft/soft_bodies.h"
#include "renderer/soft/soft_ground.h"
#include "renderer/soft/soft_particles.h"
#include "renderer/soft/soft_plants.h"
#include "world/runtime/thread_pool.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum stage {
    STAGE_TILES,
    STAGE_PREPARE,
    STAGE_GROUND,
    STAGE_SHADOWS,
    STAGE_BODIES,
    STAGE_PLANTS,
    STAGE_SHADE,
    STAGE_PARTICLES,
    STAGE_FXAA,
    STAGE_COUNT
};

static const char *const stage_names[STAGE_COUNT] = {
    [STAGE_TILES] = "tiles",     [STAGE_PREPARE] = "prepare", [STAGE_GROUND] = "ground",
    [STAGE_SHADOWS] = "shadows", [STAGE_BODIES] = "bodies",   [STAGE_PLANTS] = "plants",
    [STAGE_SHADE] = "resolve",   [STAGE_PARTICLES] = "puffs", [STAGE_FXAA] = "smooth",
};

_Static_assert(STAGE_COUNT <= BACK_END_STAGES_MAX, "more stages than can be told");

enum soft_kind { KIND_GROUND, KIND_BODIES, KIND_PLANTS, KIND_PARTICLES, KIND_COUNT };

/* The data of one thread. */
struct soft_worker {
    _Alignas(SOFT_ALIGN) uint32_t *colour; /* of a band; owned */
    float *depth;
    uint64_t cpu_ns[STAGE_COUNT]; /* for this picture */
    uint64_t mark_ns;
};

struct soft {
    struct soft_ground *ground;
    struct soft_bodies *bodies;
    struct soft_plants *plants;
    struct soft_particles *particles;
    const struct soft_kernels *kernels;
    struct thread_pool *workers;
    struct soft_worker worker[THREAD_POOL_MAX];
    uint32_t width, height; /* of the largest picture */
    struct image drawn;     /* before FXAA */
    struct image *smoothed; /* the caller's picture, after FXAA */
    /* The bands of this picture that are drawn, and those that a thread has taken for FXAA. */
    atomic_bool ready[SOFT_BANDS_MAX], taken[SOFT_BANDS_MAX];
    struct soft_frame frame;
    int failed[KIND_COUNT]; /* set by the thread that prepares the kind */
    struct back_end_stages stages;
};

/* --- timing ------------------------------------------------------------------------------------
 */

static uint64_t cpu_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

static void start_timer(struct soft_worker *worker)
{
    worker->mark_ns = cpu_ns();
}

/* Adds the processor time since the last mark to a stage. */
static void add_time(struct soft_worker *worker, enum stage stage)
{
    uint64_t now = cpu_ns();
    worker->cpu_ns[stage] += now - worker->mark_ns;
    worker->mark_ns = now;
}

static const struct back_end_stages *soft_stages(void *self)
{
    struct soft *soft = self;
    soft->stages.count = STAGE_COUNT;
    for (uint32_t s = 0; s < STAGE_COUNT; s++) {
        soft->stages.stage[s] = (struct back_end_stage){.name = stage_names[s]};
        for (uint32_t w = 0; w < thread_pool_threads(soft->workers); w++)
            soft->stages.stage[s].cpu_ns += soft->worker[w].cpu_ns[s];
    }
    return &soft->stages;
}

/* --- one picture -------------------------------------------------------------------------------
 */

static void set_scaled(float to[3], struct vec3 axis, double by)
{
    to[0] = (float)(axis.x * by);
    to[1] = (float)(axis.y * by);
    to[2] = (float)(axis.z * by);
}

/* Returns e^x for x in -20..20 with a relative error below 1e-9. The C library's result differs
 * between machines. */
static double exponential(double x)
{
    double part = x / 1024.0, power = 1.0 + part * (1.0 + part * (0.5 + part / 6.0));
    for (uint32_t i = 0; i < 10; i++)
        power *= power;
    return power;
}

static void frame_begin(struct soft *soft, const struct draw_list *list,
                        const struct frame_view *frame_view, const struct image *image)
{
    const struct camera *c = &list->camera;
    struct soft_frame *f = &soft->frame;
    double half_x = 0.5 * (double)image->width, half_y = 0.5 * (double)image->height;
    double wide = c->tan_x / half_x, high = c->tan_y / half_y; /* of a pixel at 1 m */
    *f = (struct soft_frame){
        .list = list,
        .frame_view = frame_view,
        .kernels = soft->kernels,
        .width = image->width,
        .height = image->height,
        .bands = (image->height + SOFT_BAND_ROWS - 1) / SOFT_BAND_ROWS,
        .centre_x = (float)half_x,
        .centre_y = (float)half_y,
        .near_m = (float)c->near_m,
        .pixel_m = (float)wide,
        .sun = {(float)SUN_X, (float)SUN_Y, (float)SUN_Z},
        .haze = (float)(list->haze ? HAZE_PER_M : CLEAR_PER_M),
        .fog = list->fog
                   ? (float)(FOG_PER_M * exponential(-(c->eye.y - FOG_BASE_M) * FOG_FALL_PER_M))
                   : 0.0f,
        .fog_fall = (float)FOG_FALL_PER_M,
        .time_s = (float)fmod(list->time_s, 3600.0),
        .texture = list->texture,
    };
    set_scaled(f->across, c->right, 1.0 / wide);
    set_scaled(f->down, c->up, -1.0 / high);
    set_scaled(f->ahead, c->forward, 1.0);
    set_scaled(f->right, c->right, 1.0);
    set_scaled(f->up, c->up, 1.0);
    set_scaled(f->forward, c->forward, 1.0);
    set_scaled(f->ray_x, c->right, wide);
    set_scaled(f->ray_y, c->up, -high);
    for (uint32_t i = 0; i < 3; i++)
        f->ray[i] = f->ahead[i] - f->centre_x * f->ray_x[i] - f->centre_y * f->ray_y[i];
}

static void prepare_kinds(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct soft *soft = context;
    for (uint32_t kind = first; kind < end; kind++) {
        int *failed = &soft->failed[kind];
        start_timer(&soft->worker[worker]);
        if (kind == KIND_GROUND)
            *failed = soft_ground_prepare(soft->ground, &soft->frame);
        else if (kind == KIND_BODIES)
            *failed = soft_bodies_prepare(soft->bodies, &soft->frame);
        else if (kind == KIND_PLANTS)
            *failed = soft_plants_prepare(soft->plants, &soft->frame);
        else
            *failed = soft_particles_prepare(soft->particles, &soft->frame);
        add_time(&soft->worker[worker], STAGE_PREPARE);
    }
}

static void fill_band(struct soft *soft, struct soft_worker *worker, const struct soft_target *t)
{
    const struct soft_frame *f = &soft->frame;
    const struct soft_kernels *k = soft->kernels;
    size_t pixels = (size_t)t->stride * (size_t)(t->end - t->first);
    start_timer(worker);
    memset(t->colour, 0, pixels * sizeof *t->colour);
    memset(t->depth, 0, pixels * sizeof *t->depth);
    k->soft_ground_fill(soft->ground, f, t);
    add_time(worker, STAGE_GROUND);
    k->soft_shadows_fill(soft->bodies, soft->plants, f, t);
    add_time(worker, STAGE_SHADOWS);
    k->soft_bodies_fill(soft->bodies, f, t);
    add_time(worker, STAGE_BODIES);
    k->soft_plants_fill(soft->plants, f, t);
    add_time(worker, STAGE_PLANTS);
    k->soft_shade_fill(soft->ground, f, t);
    add_time(worker, STAGE_SHADE);
    k->soft_particles_fill(soft->particles, f, t);
    add_time(worker, STAGE_PARTICLES);
}

/* Marks a band as drawn, and smooths each band whose neighbours above and below are drawn too.
 * Their rows are then still in the cache. */
static void smooth_ready_bands(struct soft *soft, uint32_t band)
{
    uint32_t last = soft->frame.bands - 1;
    atomic_store(&soft->ready[band], true);
    for (uint32_t at = band > 0 ? band - 1 : 0; at <= last && at <= band + 1; at++) {
        uint32_t bottom = (at + 1) * SOFT_BAND_ROWS;
        if (atomic_load(&soft->ready[at > 0 ? at - 1 : 0]) && atomic_load(&soft->ready[at]) &&
            atomic_load(&soft->ready[at < last ? at + 1 : last]) &&
            !atomic_exchange(&soft->taken[at], true))
            fxaa_rows(soft->smoothed, &soft->drawn, at * SOFT_BAND_ROWS,
                      at < last ? bottom : soft->frame.height);
    }
}

static void draw_bands(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct soft *soft = context;
    const struct soft_frame *f = &soft->frame;
    struct soft_target target = {
        .colour = soft->worker[worker].colour,
        .depth = soft->worker[worker].depth,
        .width = f->width,
        .stride = (f->width + 15u) & ~15u,
    };
    size_t row_bytes = (size_t)f->width * 4;
    for (target.band = first; target.band < end; target.band++) {
        int32_t bottom = (int32_t)(target.band + 1) * SOFT_BAND_ROWS;
        target.first = (int32_t)target.band * SOFT_BAND_ROWS;
        target.end = bottom < (int32_t)f->height ? bottom : (int32_t)f->height;
        uint8_t *rows = soft->drawn.pixels + (size_t)target.first * row_bytes;
        bool whole =
            target.stride == target.width; /* the band can be drawn in the picture itself */
        if (whole)
            target.colour = (uint32_t *)(void *)rows;
        fill_band(soft, &soft->worker[worker], &target);
        for (int32_t y = target.first; y < target.end && !whole; y++)
            memcpy(rows + (size_t)(y - target.first) * row_bytes,
                   target.colour + (size_t)(y - target.first) * target.stride, row_bytes);
        smooth_ready_bands(soft, target.band);
        add_time(&soft->worker[worker], STAGE_FXAA);
    }
}

static int soft_picture(void *self, const struct draw_list *list,
                        const struct frame_view *frame_view, struct image *image,
                        struct error_text *error)
{
    struct soft *soft = self;
    if (image->width > soft->width || image->height > soft->height)
        return error_text_set(error, "a %ux%u picture was asked of a back end opened for %ux%u",
                              image->width, image->height, soft->width, soft->height);
    for (uint32_t w = 0; w < thread_pool_threads(soft->workers); w++)
        memset(soft->worker[w].cpu_ns, 0, sizeof soft->worker[w].cpu_ns);
    frame_begin(soft, list, frame_view, image);
    start_timer(&soft->worker[0]);
    soft_ground_update(soft->ground, &soft->frame);
    add_time(&soft->worker[0], STAGE_TILES);
    thread_pool_run(soft->workers, prepare_kinds, soft, KIND_COUNT, 1);
    int failed = 0;
    for (uint32_t kind = 0; kind < KIND_COUNT; kind++)
        failed |= soft->failed[kind];
    if (failed != 0)
        return error_text_set(error, "no memory for the lists of a picture");
    soft->drawn.width = image->width;
    soft->drawn.height = image->height;
    soft->smoothed = image;
    for (uint32_t band = 0; band < soft->frame.bands; band++) {
        atomic_init(&soft->ready[band], false);
        atomic_init(&soft->taken[band], false);
    }
    thread_pool_run(soft->workers, draw_bands, soft, soft->frame.bands, 1);
    return 0;
}

/* --- opening and closing -----------------------------------------------------------------------
 */

static void soft_close(void *self)
{
    struct soft *soft = self;
    thread_pool_destroy(soft->workers);
    soft_ground_close(soft->ground);
    soft_bodies_close(soft->bodies);
    soft_plants_close(soft->plants);
    soft_particles_close(soft->particles);
    for (uint32_t w = 0; w < THREAD_POOL_MAX; w++) {
        free(soft->worker[w].colour);
        free(soft->worker[w].depth);
    }
    image_free(&soft->drawn);
    free(soft);
}

static const struct soft_kernels *best_kernels(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2"))
        return &soft_kernels_avx2;
#endif
    return &soft_kernels_plain;
}

const char *soft_vectors(void)
{
    return best_kernels() == &soft_kernels_plain ? "SSE2" : "AVX2";
}

static int open_parts(struct soft *soft, const struct static_scene *static_scene, uint32_t threads,
                      struct error_text *error)
{
    size_t band = ((size_t)soft->width + 15u) / 16u * 16u * SOFT_BAND_ROWS * sizeof(uint32_t);
    size_t bands = ((size_t)soft->height + SOFT_BAND_ROWS - 1) / SOFT_BAND_ROWS;
    soft->drawn.pixels = aligned_alloc(SOFT_ALIGN, band * bands);
    bool room = soft->drawn.pixels != NULL;
    soft->workers = thread_pool_create(threads);
    for (uint32_t w = 0; w < threads; w++) {
        soft->worker[w].colour = aligned_alloc(SOFT_ALIGN, band);
        soft->worker[w].depth = aligned_alloc(SOFT_ALIGN, band);
        room = room && soft->worker[w].colour != NULL && soft->worker[w].depth != NULL;
    }
    if (!room || soft->workers == NULL)
        return error_text_set(error, "no memory or no threads for a %ux%u picture", soft->width,
                              soft->height);
    soft->ground = soft_ground_open(static_scene, error);
    soft->bodies = soft->ground
                       ? soft_bodies_open(static_scene, soft_ground_detail(soft->ground), error)
                       : NULL;
    soft->plants = soft->bodies ? soft_plants_open(error) : NULL;
    soft->particles = soft->plants ? soft_particles_open(error) : NULL;
    return soft->particles ? 0 : -1;
}

int soft_open_build(struct back_end_interface *draw, const struct static_scene *static_scene,
                    uint32_t width, uint32_t height, uint32_t threads,
                    const struct soft_kernels *kernels, struct error_text *error)
{
    if (width < 1 || height < 1 || width > SOFT_SIDE_MAX || height > SOFT_SIDE_MAX)
        return error_text_set(error, "a picture of %ux%u: a side is 1 .. %d", width, height,
                              SOFT_SIDE_MAX);
    threads = threads < 1 ? 1 : threads > THREAD_POOL_MAX ? THREAD_POOL_MAX : threads;
    struct soft *soft = aligned_alloc(SOFT_ALIGN, sizeof *soft);
    if (soft == NULL)
        return error_text_set(error, "no memory for drawing");
    memset(soft, 0, sizeof *soft);
    soft->width = width;
    soft->height = height;
    soft->kernels = kernels;
    if (open_parts(soft, static_scene, threads, error) != 0) {
        soft_close(soft);
        return -1;
    }
    *draw = (struct back_end_interface){
        .self = soft, .picture = soft_picture, .stages = soft_stages, .close = soft_close};
    return 0;
}

int soft_open(struct back_end_interface *draw, const struct static_scene *static_scene,
              uint32_t width, uint32_t height, uint32_t threads, struct error_text *error)
{
    return soft_open_build(draw, static_scene, width, height, threads, best_kernels(), error);
}
