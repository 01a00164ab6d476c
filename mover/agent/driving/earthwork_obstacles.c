/* Cuts a way with the rectangles of works. */
#include "mover/agent/driving/earthwork_obstacles.h"

#include "world/maths/maths.h"
#include "world/terrain/gridsquare.h"

#include <math.h>

/* Where a way comes into a work's rectangle and leaves it. */
struct cut {
    double from_m, to_m;   /* along the way */
    double rise_m, fall_m; /* length of the slope by which it comes in, and leaves */
};

/* Cuts a way with a strip about one axis of a work. at, u: the start and the direction of the way
 * along this axis. low_m, high_m: the slopes at its ends. */
static void cut_strip(struct cut *cut, double at, double u, double half, double low_m,
                      double high_m)
{
    if (fabs(u) < 1e-9) {
        if (fabs(at) >= half)
            cut->to_m = -INFINITY;
        return;
    }
    double from = ((u > 0.0 ? -half : half) - at) / u, to = ((u > 0.0 ? half : -half) - at) / u;
    if (from > cut->from_m) {
        cut->from_m = from;
        cut->rise_m = u > 0.0 ? low_m : high_m;
    }
    if (to < cut->to_m) {
        cut->to_m = to;
        cut->fall_m = u > 0.0 ? high_m : low_m;
    }
}

/* beside_m: by so much the rectangle is wider. */
static struct cut cut_of(const struct earthwork *work, const struct earthwork_way *way,
                         double beside_m)
{
    struct cut cut = {.from_m = -INFINITY, .to_m = INFINITY};
    double dx = way->x - work->x, dz = way->z - work->z;
    cut_strip(&cut, dx * work->sine - dz * work->cosine,
              way->ux * work->sine - way->uz * work->cosine, work->half_length + beside_m,
              work->back_m, work->front_m);
    cut_strip(&cut, dx * work->cosine + dz * work->sine,
              way->ux * work->cosine + way->uz * work->sine, work->half_width + beside_m,
              work->side_m, work->side_m);
    return cut;
}

/* Returns true if the kind can cross the work along the cut. */
static bool crosses(const struct earthwork *work, const struct kind *kind, const struct cut *cut,
                    double beside_m)
{
    double high = fabs(work->height_m), sine, cosine;
    double water = work->shape == EARTHWORK_FORD ? -work->height_m - work->freeboard_m : 0.0;
    maths_sincos(kind->max_slope_rad, &sine, &cosine);
    bool steep = high * cosine > sine * maths_min(cut->rise_m, cut->fall_m);
    if (water > kind->ford_m)
        return false;
    if (high <= kind->step_m || !steep || work->wave_m > 0.0)
        return true;
    return work->height_m < 0.0 && cut->to_m - cut->from_m - 2.0 * beside_m <= kind->trench_m;
}

/* Returns true if the way leads over the work. A vehicle that stands beside the work, or with a
 * part of it on its edge, may leave it or go along it. */
static bool leads_over(const struct earthwork *work, const struct earthwork_way *way,
                       struct cut *cut)
{
    *cut = cut_of(work, way, way->beside_m);
    if (!(cut->from_m < cut->to_m) || cut->to_m <= 0.0 || earthwork_holds(work, way->x, way->z))
        return false;
    if (cut->from_m > 0.0)
        return true;
    const struct cut narrow = cut_of(work, way, 0.0);
    return narrow.from_m < narrow.to_m && narrow.to_m > 0.0;
}

/* --- works along a way -------------------------------------------------------------------------*/

/* What is asked of each work that a way comes near. */
struct question {
    const struct kind *kind;
    const struct earthwork_way *way;
    double far_m;  /* that the vehicle's nose comes along the way */
    double free_m; /* the answer of free_of() */
    earthwork_face *face;
    void *context; /* of the face */
};

typedef void question_ask(struct question *question, const struct earthwork *work);

static void ask_all(const struct earthworks *works, struct question *question, question_ask *ask)
{
    const struct earthwork_way *way = question->way;
    double end_x = way->x + question->far_m * way->ux, end_z = way->z + question->far_m * way->uz;
    double wide = way->beside_m;
    struct gridsquare_box box = gridsquare_box_of(
        &works->squares, maths_min(way->x, end_x) - wide, maths_min(way->z, end_z) - wide,
        maths_max(way->x, end_x) + wide, maths_max(way->z, end_z) + wide);
    for (int32_t row = box.z0; row <= box.z1 && works->count > 0; row++) {
        for (int32_t column = box.x0; column <= box.x1; column++) {
            uint32_t count;
            const uint32_t *items =
                earthwork_in_square(works, gridsquare_index(&works->squares, column, row), &count);
            for (uint32_t n = 0; n < count; n++)
                ask(question, &works->works[items[n]]);
        }
    }
}

static void free_of(struct question *question, const struct earthwork *work)
{
    const struct earthwork_way *way = question->way;
    struct cut cut;
    if (leads_over(work, way, &cut) && cut.from_m < question->far_m &&
        !crosses(work, question->kind, &cut, way->beside_m))
        question->free_m = maths_min(question->free_m, cut.from_m + way->beside_m - way->ahead_m);
}

double earthwork_obstacles_free(const struct earthworks *works, const struct kind *kind,
                                const struct earthwork_way *way)
{
    struct question question = {
        .kind = kind, .way = way, .far_m = way->length_m + way->ahead_m, .free_m = way->length_m};
    ask_all(works, &question, free_of);
    return maths_max(question.free_m, 0.0);
}

/* --- faces -------------------------------------------------------------------------------------*/

/* Tells of a face from one place of the way to another, unless all of the vehicle is past it. */
static void tell_face(const struct question *question, double from_m, double to_m, double rise_m)
{
    double ahead_m = question->way->ahead_m;
    if (from_m < question->far_m && to_m + ahead_m > 0.0)
        question->face(question->context, maths_max(from_m - ahead_m, 0.0),
                       rise_m / (to_m - from_m));
}

static void faces_of(struct question *question, const struct earthwork *work)
{
    const double beside_m = question->way->beside_m, high_m = work->height_m;
    const struct cut cut = cut_of(work, question->way, beside_m);
    const double from_m = cut.from_m + beside_m, to_m = cut.to_m - beside_m;
    if (!(cut.from_m < cut.to_m) || high_m == 0.0 || work->wave_m > 0.0 ||
        !crosses(work, question->kind, &cut, beside_m) ||
        (high_m < 0.0 && to_m - from_m <= question->kind->trench_m))
        return;
    tell_face(question, from_m, from_m + cut.rise_m, high_m);
    tell_face(question, to_m - cut.fall_m, to_m, -high_m);
}

void earthwork_obstacles_faces(const struct earthworks *works, const struct kind *kind,
                               const struct earthwork_way *way, earthwork_face *face, void *context)
{
    struct question question = {.kind = kind,
                                .way = way,
                                .far_m = way->length_m + way->ahead_m,
                                .face = face,
                                .context = context};
    ask_all(works, &question, faces_of);
}
