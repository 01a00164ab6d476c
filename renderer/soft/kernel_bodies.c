/* Sets up bodies and their shadows: corners are transformed, lit and projected, faces set up. */
#include "renderer/soft/atmosphere.h"
#include "renderer/soft/body_deform.h"
#include "renderer/soft/kernel.h"
#include "renderer/soft/soft_bodies.h"
#include "renderer/soft/triangle_raster.h"

#define SHADOW_BIAS   0.002f /* of the distance, by which a shadow is nearer than its plane, */
#define SHADOW_PIXELS 2.0f   /* plus the plane's slope over this many pixels */

/* The map m * v + t. */
struct affine {
    float m[3][3], t[3];
};

/* The state of setting up one body. */
struct body_setup {
    struct soft_bodies *bodies;
    const struct soft_frame *frame;
    const struct draw_list_body *body;
    const struct soft_mesh *mesh;
    const struct mesh_skeleton *skeleton;
    struct body_deform deform;
    struct soft_material material;
    float dark;   /* of its shadow; 0: no shadow */
    float link_m; /* length of its tracks' links */
    bool deformed, textured, cuts;
    /* At most eight faces that are set up together, and the corners that clipping has added for
     * them. */
    uint32_t corner[3][LANES];
    const struct soft_face *face[LANES];
    uint32_t count, cut;
};

/* --- parts ------------------------------------------------------------------------------------ */

static const struct affine identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};

/* Returns the map that applies b, then a. */
static struct affine compose(const struct affine *a, const struct affine *b)
{
    struct affine both;
    for (uint32_t i = 0; i < 3; i++) {
        both.t[i] = a->t[i];
        for (uint32_t j = 0; j < 3; j++) {
            both.m[i][j] =
                a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j];
            both.t[i] += a->m[i][j] * b->t[j];
        }
    }
    return both;
}

/* Returns a rotation about a pivot from axis i towards axis j. */
static struct affine rotation_about(const float pivot[4], uint32_t i, uint32_t j, float angle_rad)
{
    double s, c;
    struct affine a = identity;
    maths_sincos((double)angle_rad, &s, &c);
    a.m[i][i] = a.m[j][j] = (float)c;
    a.m[i][j] = -(float)s;
    a.m[j][i] = (float)s;
    for (uint32_t k = 0; k < 3; k++)
        a.t[k] = pivot[k] - a.m[k][0] * pivot[0] - a.m[k][1] * pivot[1] - a.m[k][2] * pivot[2];
    return a;
}

/* Returns how far the running gear has moved [rad or links]. */
static float travel_of(const struct body_setup *m, const struct soft_group *group)
{
    const float *pivot = m->skeleton->pivot[group->joint];
    return m->body->travel_m[pivot[2] < 0.0f ? 0 : 1] / pivot[3];
}

/* Returns the motion of a part before the deformation. */
static struct affine rolled(const struct body_setup *m, const struct soft_group *group)
{
    const float *pivot = m->skeleton->pivot[group->joint];
    if (group->part != PART_WHEEL && group->part != PART_FRONT_WHEEL)
        return identity;
    struct affine roll = rotation_about(pivot, 0, 1, -travel_of(m, group));
    if (group->part == PART_WHEEL)
        return roll;
    struct affine steer = rotation_about(pivot, 0, 2, m->body->steer_rad);
    return compose(&steer, &roll);
}

/* Returns the motion of a part after the deformation. */
static struct affine turned(const struct body_setup *m, const struct soft_group *group)
{
    const struct draw_list_body *body = m->body;
    const float *pivot = m->skeleton->pivot[group->joint];
    struct affine turret, gun;
    switch (group->part) {
    case PART_TAIL_ROTOR:
        return rotation_about(pivot, 0, 1, body->rotor_rad);
    case PART_ROTOR:
        return rotation_about(pivot, 0, 2, body->rotor_rad);
    case PART_TURRET:
        return rotation_about(m->skeleton->pivot[0], 0, 2, body->turret_rad);
    case PART_GUN:
        turret = rotation_about(m->skeleton->pivot[0], 0, 2, body->turret_rad);
        gun = rotation_about(pivot, 0, 1, body->gun_rad);
        return compose(&turret, &gun);
    default:
        return identity;
    }
}

/* --- corners ---------------------------------------------------------------------------------- */

SIMD8 void load3(v8f v[3], float *const column[3], uint32_t at)
{
    for (uint32_t i = 0; i < 3; i++)
        v[i] = simd8_load_f(column[i] + at);
}

SIMD8 void store3(float *const column[3], uint32_t at, const v8f v[3])
{
    for (uint32_t i = 0; i < 3; i++)
        simd8_store_f(column[i] + at, v[i]);
}

SIMD8 void apply(const struct affine *a, const v8f v[3], float one, v8f out[3])
{
    for (uint32_t i = 0; i < 3; i++)
        out[i] = simd8_dot3_f(a->m[i], v) + one * a->t[i];
}

/* Deforms a group's corners. The normals stay those of the original shape. */
static void deform_group(const struct body_setup *m, const struct soft_group *group)
{
    float **column = m->bodies->column;
    struct affine roll = rolled(m, group);
    for (uint32_t at = group->first; at < group->end; at += LANES) {
        v8f built[3], v[3], n[3], normal[3];
        load3(built, m->mesh->column + MESH_PLACE_X, at);
        load3(n, m->mesh->column + MESH_NORMAL_X, at);
        apply(&roll, built, 1.0f, v);
        apply(&roll, n, 0.0f, normal);
        v8f bare = m->deform.dent_count > 0 ? body_deform_bare(&m->deform, v) : simd8_f(0.0f);
        v8f fell = m->deform.collapsed ? body_deform_collapsed(&m->deform, built) : simd8_f(0.0f);
        body_deform_corners(&m->deform, v);
        simd8_store_f(column[CORNER_VALUE + VALUE_BARE] + at, bare);
        simd8_store_f(column[CORNER_VALUE + VALUE_COLLAPSED] + at, fell);
        store3(column + CORNER_PLACE, at, v);
        store3(column + CORNER_NORMAL, at, normal);
    }
}

/* Adds each deformed face's normal to those of its deformed corners. */
static void deform_normals(const struct body_setup *m)
{
    float *const *place = m->bodies->column + CORNER_PLACE;
    float *const *normal = m->bodies->column + CORNER_NORMAL;
    const float *bare = m->bodies->column[CORNER_VALUE + VALUE_BARE];
    const float *fell = m->bodies->column[CORNER_VALUE + VALUE_COLLAPSED];
    for (uint32_t i = 0; i < m->mesh->face_count; i++) {
        const uint32_t *corner = m->mesh->faces[i].corner;
        float u[3], v[3], across[3];
        for (uint32_t axis = 0; axis < 3; axis++) {
            u[axis] = place[axis][corner[1]] - place[axis][corner[0]];
            v[axis] = place[axis][corner[2]] - place[axis][corner[0]];
        }
        for (uint32_t axis = 0; axis < 3; axis++) {
            uint32_t next = axis < 2 ? axis + 1 : 0, last = axis > 0 ? axis - 1 : 2;
            across[axis] = u[next] * v[last] - u[last] * v[next];
        }
        /* The factor makes the unit normals that are already there negligible. */
        for (uint32_t k = 0; k < 3; k++)
            if (m->deform.broken || bare[corner[k]] > 0.0f || fell[corner[k]] > 0.0f)
                for (uint32_t axis = 0; axis < 3; axis++)
                    normal[axis][corner[k]] += 1.0e4f * across[axis];
    }
}

/* Returns the light on corners. The sky lights surfaces that face up, the ground reflects a little,
 * and both are weaker low under a body. world: points from the eye [m]; n: unit normals; high:
 * height above the body's bottom [m]. */
SIMD8 struct colour8 corner_light(const struct soft_frame *f, const v8f world[3], const v8f n[3],
                                  v8f high)
{
    struct colour8 sun_light = colour_of(SUN_LIGHT_RED, SUN_LIGHT_GREEN, SUN_LIGHT_BLUE);
    struct colour8 sky =
        colour_of(SKY_LIGHT_RED * 1.12f, SKY_LIGHT_GREEN * 1.12f, SKY_LIGHT_BLUE * 1.12f);
    v8f zero = simd8_f(0.0f), sun = simd8_max(simd8_dot3_f(f->sun, n), zero);
    v8f open = 0.55f + 0.45f * simd8_smoothstep(0.0f, 1.3f, high);
    struct colour8 around = colour_mix(colour_of(0.36f, 0.31f, 0.24f), sky, 0.5f + 0.5f * n[1]);
    v8f far = simd8_sqrt(simd8_dot3(world, world)), along = 2.0f * simd8_dot3(world, n),
        towards = zero;
    for (uint32_t i = 0; i < 3; i++)
        towards += (world[i] - along * n[i]) * f->sun[i];
    v8f back = simd8_max(towards / far, zero), square = back * back, fourth = square * square;
    v8f strong =
        sun * (0.8f + 0.2f * (open - 0.55f) * (1.0f / 0.45f)) + 0.16f * fourth * fourth * fourth;
    return (struct colour8){around.r * open + sun_light.r * strong,
                            around.g * open + sun_light.g * strong,
                            around.b * open + sun_light.b * strong};
}

/* Projects points from the eye and stores them as corners from index at on, in the columns of a set
 * (for the body or its shadow). */
SIMD8 void project(const struct soft_frame *f, float *const *column, uint32_t at,
                   const v8f place[3])
{
    v8f ahead = simd8_dot3_f(f->ahead, place);
    v8f across = simd8_dot3_f(f->across, place);
    v8f down = simd8_dot3_f(f->down, place);
    v8f over = 1.0f / simd8_max(ahead, simd8_f(1e-3f));
    simd8_store_f(column[CORNER_AHEAD] + at, ahead);
    simd8_store_f(column[CORNER_ACROSS] + at, across);
    simd8_store_f(column[CORNER_DOWN] + at, down);
    simd8_store_f(column[CORNER_OVER] + at, over);
    simd8_store_f(column[CORNER_COLUMN] + at, f->centre_x + across * over);
    simd8_store_f(column[CORNER_ROW] + at, f->centre_y + down * over);
}

/* Moves points along the sun's light onto the plane. */
SIMD8 void project_onto(const struct soft_frame *f, const float plane[4], v8f place[3])
{
    float steep = 1.0f / (plane[0] * f->sun[0] + plane[1] * f->sun[1] + plane[2] * f->sun[2]);
    v8f high = simd8_dot3_f(plane, place) - plane[3];
    v8f back = simd8_max(high * steep, simd8_f(0.0f));
    for (uint32_t i = 0; i < 3; i++)
        place[i] -= f->sun[i] * back;
}

static struct affine body_to_world(const struct draw_list_body *body)
{
    struct affine a;
    for (uint32_t i = 0; i < 3; i++) {
        a.m[i][0] = body->forward[i];
        a.m[i][1] = body->up[i];
        a.m[i][2] = body->right[i];
        a.t[i] = body->at[i];
    }
    return a;
}

/* Projects and lights the corners of a part. seen: the body itself is visible, not only its
 * shadow. */
static void place_group(const struct body_setup *m, const struct soft_group *group, bool seen)
{
    float **column = m->bodies->column;
    float *const *value = column + CORNER_VALUE, *const *mesh = m->mesh->column;
    float *const *from = m->deformed ? column + CORNER_PLACE : mesh + MESH_PLACE_X;
    float *const *facing = m->deformed ? column + CORNER_NORMAL : mesh + MESH_NORMAL_X;
    struct affine part = turned(m, group), world = body_to_world(m->body);
    if (!m->deformed) {
        struct affine roll = rolled(m, group);
        part = compose(&part, &roll);
    }
    world = compose(&world, &part);
    float links = group->part == PART_TRACK ? travel_of(m, group) : 0.0f, low = m->skeleton->low[1];
    for (uint32_t at = group->first; at < group->end; at += LANES) {
        v8f v[3], n[3], place[3], normal[3];
        load3(v, from, at);
        apply(&world, v, 1.0f, place);
        if (m->dark > 0.0f) {
            v8f collapsed[3] = {place[0], place[1], place[2]};
            project_onto(m->frame, m->body->plane, collapsed);
            project(m->frame, column + CORNER_SHADOW, at, collapsed);
        }
        if (!seen)
            continue;
        project(m->frame, column, at, place);
        load3(n, facing, at);
        apply(&world, n, 0.0f, normal);
        v8f over = 1.0f / simd8_sqrt(simd8_dot3(normal, normal) + 1e-20f);
        for (uint32_t i = 0; i < 3; i++)
            normal[i] *= over;
        v8f high = simd8_dot3_f(part.m[1], v) + part.t[1];
        struct colour8 light = corner_light(m->frame, place, normal, high - low);
        simd8_store_f(value[VALUE_RED] + at, light.r);
        simd8_store_f(value[VALUE_GREEN] + at, light.g);
        simd8_store_f(value[VALUE_BLUE] + at, light.b);
        simd8_store_f(value[VALUE_ALONG] + at, simd8_load_f(mesh[MESH_ALONG] + at) + links);
    }
}

/* --- faces ------------------------------------------------------------------------------------ */

enum face_kind { FACE_FLAT, FACE_TEXTURED, FACE_SHADOW };

SIMD8 v8f corner_value(const struct body_setup *m, uint32_t column, v8i corner)
{
    return simd8_gather_f(m->bodies->column[column], corner);
}

/* Returns the base colours of the faces, tinted by the force. worn: 1 for camouflage paint, else
 * 0. */
SIMD8 struct colour8 base_colours(const struct body_setup *m, v8f *worn)
{
    struct colour8 c;
    const float *tint = m->body->tint;
    for (uint32_t i = 0; i < LANES; i++) {
        const struct soft_face *face = m->face[i < m->count ? i : 0];
        c.r[i] = face->red;
        c.g[i] = face->green;
        c.b[i] = face->blue;
        (*worn)[i] = face->force_tint;
    }
    *worn *= 1.0f / 255.0f;
    c = colour_scale(c, simd8_f(1.0f / 255.0f));
    v8f bright = 0.55f + 0.3f * (c.r + c.g + c.b);
    struct colour8 force = {tint[0] * bright, tint[1] * bright, tint[2] * bright};
    c = colour_mix(c, force, 0.85f * *worn);
    *worn = simd8_select((*worn >= 0.29f) & (*worn <= 0.6f), simd8_f(1.0f), simd8_f(0.0f));
    return c;
}

/* Returns the colours of flat faces, for which the mean of the textures is used. */
SIMD8 v8u flat_colours(const struct body_setup *m, const v8i corner[3])
{
    const struct soft_material *p = &m->material;
    v8f worn, light[3];
    struct colour8 c = base_colours(m, &worn);
    for (uint32_t i = 0; i < 3; i++)
        light[i] = (corner_value(m, CORNER_VALUE + VALUE_RED + i, corner[0]) +
                    corner_value(m, CORNER_VALUE + VALUE_RED + i, corner[1]) +
                    corner_value(m, CORNER_VALUE + VALUE_RED + i, corner[2])) *
                   (p->clear / 3.0f);
    if (m->frame->texture) {
        v8f soot = simd8_clamp((0.65f - simd8_f(p->soot_low)) * p->soot_over, 0.0f, 1.0f);
        soot = simd8_max(soot * soot * (3.0f - 2.0f * soot) * p->soot_most, simd8_f(p->burnt));
        c = colour_mix(colour_scale(c, 1.0f - 0.15f * worn), colour_of(0.055f, 0.05f, 0.047f),
                       soot);
    } else {
        c = colour_mix(c, colour_of(0.07f, 0.07f, 0.07f), simd8_f(p->plain));
    }
    return simd8_pack(c.r * light[0] + p->air[0], c.g * light[1] + p->air[1],
                      c.b * light[2] + p->air[2]);
}

static struct band_rows *next_rows(struct soft_faces *faces, const struct edges8 *s, uint32_t lane)
{
    struct band_rows *rows = &faces->rows[faces->count++];
    *rows = (struct band_rows){(int16_t)s->first[lane], (int16_t)s->end[lane]};
    return rows;
}

SIMD8 void put_flat_faces(struct body_setup *m, const struct edges8 *s, const v8i corner[3],
                          uint32_t lanes)
{
    struct soft_faces *faces = &m->bodies->flat_faces;
    struct plane8 depth = triangle_raster_plane(s, corner_value(m, CORNER_OVER, corner[0]),
                                                corner_value(m, CORNER_OVER, corner[1]),
                                                corner_value(m, CORNER_OVER, corner[2]));
    v8u colours = flat_colours(m, corner);
    for (; lanes != 0; lanes &= lanes - 1) {
        uint32_t lane = (uint32_t)__builtin_ctz(lanes);
        struct soft_flat_face *flat = (struct soft_flat_face *)faces->list + faces->count;
        *flat = (struct soft_flat_face){triangle_raster_of(s, (int)lane),
                                        triangle_raster_plane_of(&depth, (int)lane), colours[lane]};
        next_rows(faces, s, lane);
    }
}

/* Returns the mip whose texels are as large as pixels, or a little smaller. */
SIMD8 v8i mip_of(v8f pixel_m, float per_m)
{
    v8f texels =
        simd8_max(pixel_m * (per_m * 0.93f * (float)(1 << SOFT_DETAIL_POWER)), simd8_f(1.0f));
    v8i mip = (v8i)((v8u)texels >> 23) - 127;
    return simd8_select_i(mip < SOFT_DETAIL_MIPS, mip, simd8_i(SOFT_DETAIL_MIPS - 1));
}

SIMD8 void put_textured_faces(struct body_setup *m, const struct edges8 *s, const v8i corner[3],
                              uint32_t lanes)
{
    struct soft_faces *faces = &m->bodies->textured_faces;
    v8f over[3], worn;
    for (uint32_t i = 0; i < 3; i++)
        over[i] = corner_value(m, CORNER_OVER, corner[i]);
    struct plane8 depth = triangle_raster_plane(s, over[0], over[1], over[2]), value[VALUE_COUNT];
    for (uint32_t i = 0; i < VALUE_COUNT; i++)
        if (m->deformed || (i != VALUE_COLLAPSED && i != VALUE_BARE))
            value[i] =
                triangle_raster_plane(s, corner_value(m, CORNER_VALUE + i, corner[0]) * over[0],
                                      corner_value(m, CORNER_VALUE + i, corner[1]) * over[1],
                                      corner_value(m, CORNER_VALUE + i, corner[2]) * over[2]);
        else
            value[i] = (struct plane8){simd8_f(0.0f), simd8_f(0.0f), simd8_f(0.0f)};
    v8f pixel_m = 3.0f * m->frame->pixel_m / (over[0] + over[1] + over[2]);
    v8i broad = mip_of(pixel_m, PATTERN_BROAD_PER_M), fine = mip_of(pixel_m, PATTERN_FINE_PER_M);
    /* The largest mip would not fit the nearer caches, and its detail does not show. */
    fine = simd8_select_i(fine > 0, fine, simd8_i(1));
    struct colour8 c = base_colours(m, &worn);
    /* Links show until they are narrower than pixels. */
    v8f links = simd8_clamp(1.5f - 2.0f * pixel_m / m->link_m, 0.0f, 1.0f);
    for (; lanes != 0; lanes &= lanes - 1) {
        uint32_t lane = (uint32_t)__builtin_ctz(lanes);
        struct soft_textured_face *side = (struct soft_textured_face *)faces->list + faces->count;
        side->edges = triangle_raster_of(s, (int)lane);
        side->depth = triangle_raster_plane_of(&depth, (int)lane);
        for (uint32_t i = 0; i < VALUE_COUNT; i++)
            side->value[i] = triangle_raster_plane_of(&value[i], (int)lane);
        side->colour[0] = c.r[lane];
        side->colour[1] = c.g[lane];
        side->colour[2] = c.b[lane];
        side->worn = worn[lane];
        side->links = links[lane];
        side->material = (uint16_t)(m->bodies->material_count - 1);
        side->broad = (uint8_t)broad[lane];
        side->fine = (uint8_t)fine[lane];
        side->track = m->face[lane]->track;
        next_rows(faces, s, lane);
    }
}

SIMD8 void put_shadow_faces(struct body_setup *m, const struct edges8 *s, const v8i corner[3],
                            uint32_t lanes)
{
    struct soft_faces *faces = &m->bodies->shadow_faces;
    struct plane8 depth =
        triangle_raster_plane(s, corner_value(m, CORNER_SHADOW + CORNER_OVER, corner[0]),
                              corner_value(m, CORNER_SHADOW + CORNER_OVER, corner[1]),
                              corner_value(m, CORNER_SHADOW + CORNER_OVER, corner[2]));
    float more = 1.0f + SHADOW_BIAS;
    depth.top = more * depth.top + SHADOW_PIXELS * (simd8_abs(depth.x) + simd8_abs(depth.y));
    depth.x *= more;
    depth.y *= more;
    for (; lanes != 0; lanes &= lanes - 1) {
        uint32_t lane = (uint32_t)__builtin_ctz(lanes);
        struct soft_shadow_face *shade = (struct soft_shadow_face *)faces->list + faces->count;
        *shade = (struct soft_shadow_face){triangle_raster_of(s, (int)lane),
                                           triangle_raster_plane_of(&depth, (int)lane),
                                           (uint32_t)(m->dark * (float)SOFT_SHADOW_FULL + 0.5f)};
        next_rows(faces, s, lane);
    }
}

/* Sets up the collected faces. */
SIMD8 void flush_faces(struct body_setup *m, enum face_kind kind)
{
    uint32_t set = kind == FACE_SHADOW ? CORNER_SHADOW : 0;
    struct corners8 c;
    struct edges8 s;
    v8i corner[3];
    if (m->count == 0)
        return;
    for (uint32_t i = 0; i < 3; i++) {
        for (uint32_t lane = 0; lane < LANES; lane++)
            corner[i][lane] = (int32_t)m->corner[i][lane < m->count ? lane : 0];
        c.x[i] = corner_value(m, set + CORNER_COLUMN, corner[i]);
        c.y[i] = corner_value(m, set + CORNER_ROW, corner[i]);
    }
    v8i there = triangle_raster_set_up(&s, &c, m->frame->width, m->frame->height);
    there &= simd8_count() < (int32_t)m->count;
    if (m->mesh->closed)
        there &= s.area < 0.0f;
    uint32_t lanes = simd8_bits(there);
    if (lanes != 0 && kind == FACE_FLAT)
        put_flat_faces(m, &s, corner, lanes);
    if (lanes != 0 && kind == FACE_TEXTURED)
        put_textured_faces(m, &s, corner, lanes);
    if (lanes != 0 && kind == FACE_SHADOW)
        put_shadow_faces(m, &s, corner, lanes);
    m->count = m->cut = 0;
}

SIMD8 void add_face(struct body_setup *m, const struct soft_face *face, uint32_t a, uint32_t b,
                    uint32_t c)
{
    m->corner[0][m->count] = a;
    m->corner[1][m->count] = b;
    m->corner[2][m->count] = c;
    m->face[m->count++] = face;
}

/* The values of a corner that clipping interpolates. */
#define CUT_VALUES (2 + VALUE_COUNT)

_Static_assert(CUT_VALUES <= TRIANGLE_RASTER_VALUES_MAX, "more values than can be cut");

static void add_clipped_face(struct body_setup *m, const struct soft_face *face, uint32_t set)
{
    float **column = m->bodies->column;
    struct clip_corner from[3], cut[4];
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t at = face->corner[i];
        from[i].ahead = column[set + CORNER_AHEAD][at];
        from[i].value[0] = column[set + CORNER_ACROSS][at];
        from[i].value[1] = column[set + CORNER_DOWN][at];
        for (uint32_t v = 0; v < VALUE_COUNT; v++)
            from[i].value[2 + v] = column[CORNER_VALUE + v][at];
    }
    uint32_t count = triangle_raster_clip(from, CUT_VALUES, m->frame->near_m, cut);
    uint32_t first = m->mesh->corner_count + m->cut;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = first + i;
        float over = 1.0f / cut[i].ahead;
        column[set + CORNER_OVER][at] = over;
        column[set + CORNER_COLUMN][at] = m->frame->centre_x + cut[i].value[0] * over;
        column[set + CORNER_ROW][at] = m->frame->centre_y + cut[i].value[1] * over;
        for (uint32_t v = 0; v < VALUE_COUNT; v++)
            column[CORNER_VALUE + v][at] = cut[i].value[2 + v];
    }
    m->cut += count;
    for (uint32_t i = 2; i < count; i++)
        add_face(m, face, first, first + i - 1, first + i);
}

/* Sets up all faces of a body that crosses the near plane. */
SIMD8 void set_up_clipped_faces(struct body_setup *m, enum face_kind kind)
{
    uint32_t set = kind == FACE_SHADOW ? CORNER_SHADOW : 0;
    const float *ahead = m->bodies->column[set + CORNER_AHEAD];
    float near = m->frame->near_m;
    for (uint32_t i = 0; i < m->mesh->face_count; i++) {
        const struct soft_face *face = &m->mesh->faces[i];
        const uint32_t *corner = face->corner;
        if (ahead[corner[0]] < near || ahead[corner[1]] < near || ahead[corner[2]] < near)
            add_clipped_face(m, face, set);
        else
            add_face(m, face, corner[0], corner[1], corner[2]);
        if (m->count >= LANES - 1)
            flush_faces(m, kind);
    }
    flush_faces(m, kind);
}

/* Returns which of eight faces are visible, one bit each. */
SIMD8 uint32_t seen_faces(const struct body_setup *m, const struct soft_face *faces, uint32_t count,
                          uint32_t set)
{
    struct corners8 c;
    v8i lane = simd8_count();
    v8i at = simd8_select_i(lane < (int32_t)count, lane, simd8_i(0)) * (int32_t)sizeof *faces;
    for (uint32_t i = 0; i < 3; i++) {
        v8i corner = (v8i)simd8_gather_bytes(&faces->corner[i], at);
        c.x[i] = corner_value(m, set + CORNER_COLUMN, corner);
        c.y[i] = corner_value(m, set + CORNER_ROW, corner);
    }
    v8f area = triangle_raster_area(&c);
    v8i shown = triangle_raster_shown(&c, area, m->frame->width, m->frame->height);
    shown &= lane < (int32_t)count;
    return simd8_bits(m->mesh->closed ? shown & (area < 0.0f) : shown);
}

/* Sets up the visible faces. Most faces look away or contain no pixel, so the others are collected
 * before they are set up. */
SIMD8 void set_up_faces(struct body_setup *m, enum face_kind kind)
{
    uint32_t set = kind == FACE_SHADOW ? CORNER_SHADOW : 0, count = m->mesh->face_count;
    if (m->cuts) {
        set_up_clipped_faces(m, kind);
        return;
    }
    for (uint32_t i = 0; i < count; i += LANES) {
        const struct soft_face *faces = &m->mesh->faces[i];
        uint32_t bits = seen_faces(m, faces, count - i < LANES ? count - i : LANES, set);
        for (; bits != 0; bits &= bits - 1) {
            const struct soft_face *face = &faces[__builtin_ctz(bits)];
            add_face(m, face, face->corner[0], face->corner[1], face->corner[2]);
            if (m->count == LANES)
                flush_faces(m, kind);
        }
    }
    flush_faces(m, kind);
}

/* --- bodies ----------------------------------------------------------------------------------- */

static float step(float low, float high, float v)
{
    float t = (v - low) / (high - low);
    t = t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
    return t * t * (3.0f - 2.0f * t);
}

/* Computes what all faces of the body have in common, and the air in front of it. */
static void compute_material(struct body_setup *m)
{
    const float *at = m->body->at;
    v8f place[3] = {simd8_f(at[0]), simd8_f(at[1]), simd8_f(at[2])};
    struct atmosphere8 air = atmosphere_at(m->frame, place);
    float burn = m->body->burn, opacity = air.opacity[0];
    m->material = (struct soft_material){
        .soot_low = 1.12f - 1.15f * burn,
        .soot_over = 1.0f / 0.42f,
        .soot_most = fminf(0.5f + 0.8f * burn, 1.0f) * step(0.0f, 0.1f, burn),
        .burnt = 0.94f * step(0.8f, 1.0f, burn),
        .rust = burn >= 0.9f ? 0.8f : 0.0f,
        .plain = 0.9f * burn,
        .air = {opacity * air.colour.r[0], opacity * air.colour.g[0], opacity * air.colour.b[0]},
        .clear = 1.0f - opacity,
        .deformed = m->deformed,
    };
}

/* Returns true if the body's bounding sphere lies wholly outside the picture. */
static bool outside(const struct soft_frame *f, const struct soft_bounds *reach, const float at[3])
{
    float half_x = f->centre_x * f->pixel_m, half_y = f->centre_y * f->pixel_m;
    float x = fabsf(f->right[0] * at[0] + f->right[1] * at[1] + f->right[2] * at[2]);
    float y = fabsf(f->up[0] * at[0] + f->up[1] * at[1] + f->up[2] * at[2]);
    return reach->ahead + reach->metres < f->near_m ||
           x - reach->ahead * half_x > reach->metres * sqrtf(1.0f + half_x * half_x) ||
           y - reach->ahead * half_y > reach->metres * sqrtf(1.0f + half_y * half_y);
}

static void set_up_body(struct body_setup *m, uint32_t index)
{
    const struct soft_frame *f = m->frame;
    const struct draw_list_instance *instance = &f->list->instances[index];
    struct soft_bodies *bodies = m->bodies;
    struct soft_bounds reach = soft_bodies_bounds(bodies, f, index);
    m->body = &f->list->bodies[index];
    bool seen = !outside(f, &reach, m->body->at);
    if (!seen && !instance->shadow)
        return;
    m->mesh = &bodies->mesh[instance->model * MESH_DETAIL_COUNT + instance->detail];
    m->skeleton = &bodies->static_scene->skeletons[instance->model];
    m->deform = body_deform_of(m->body, f->list->dents);
    m->deformed = body_deform_any(&m->deform);
    m->textured = reach.pixels >= TEXTURED_PIXELS_MIN;
    m->cuts = reach.ahead - 4.0f * reach.metres < f->near_m;
    m->count = m->cut = 0;
    m->link_m = 1.0f;
    for (uint32_t i = 0; i < m->mesh->group_count; i++)
        if (m->mesh->groups[i].part == PART_TRACK)
            m->link_m = m->skeleton->pivot[m->mesh->groups[i].joint][3];
    compute_material(m);
    m->dark = instance->shadow ? m->material.clear : 0.0f;
    for (uint32_t i = 0; m->deformed && i < m->mesh->group_count; i++)
        deform_group(m, &m->mesh->groups[i]);
    if (m->deformed)
        deform_normals(m);
    for (uint32_t i = 0; i < m->mesh->group_count; i++)
        place_group(m, &m->mesh->groups[i], seen);
    if (m->dark > 0.0f)
        set_up_faces(m, FACE_SHADOW);
    if (!seen)
        return;
    if (!m->textured) {
        set_up_faces(m, FACE_FLAT);
        return;
    }
    bodies->materials[bodies->material_count++] = m->material;
    for (uint32_t axis = 0; axis < 3; axis++)
        memcpy(bodies->column[CORNER_VALUE + VALUE_X + axis], m->mesh->column[MESH_PLACE_X + axis],
               m->mesh->corner_count * sizeof(float));
    set_up_faces(m, FACE_TEXTURED);
}

void KERNEL(soft_bodies_set_up)(struct soft_bodies *bodies, const struct soft_frame *frame)
{
    struct body_setup setup = {.bodies = bodies, .frame = frame};
    for (uint32_t i = 0; i < frame->list->body_count; i++)
        set_up_body(&setup, i);
}
