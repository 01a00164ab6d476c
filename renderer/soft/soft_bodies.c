/* Bodies of the software back end: their meshes, texture and lists. */
#include "renderer/soft/soft_bodies.h"

#include "renderer/soft/kernel.h"

#include <stdlib.h>

#define REACH_SPARE 1.2f /* for parts that turn and metal that is bent */

/* --- opening and closing ---------------------------------------------------------------------- */

/* Builds a mesh of the list and enlarges the scratch columns for its corners. Returns 0, or -1 when
 * there is no memory. */
static int build_mesh(struct soft_bodies *bodies, uint32_t i)
{
    struct soft_mesh *mesh = &bodies->mesh[i];
    if (soft_mesh_open(mesh, bodies->static_scene->world, i / MESH_DETAIL_COUNT,
                       (enum mesh_detail)(i % MESH_DETAIL_COUNT)) != 0)
        return -1;
    bodies->built[i] = true;
    /* A column is a multiple of SOFT_ALIGN bytes long. */
    size_t room = ((size_t)mesh->corner_count + CORNERS_CUT + 15u) / 16u * 16u;
    if (room <= bodies->column_room)
        return 0;
    free(bodies->column[0]);
    bodies->column_room = 0;
    bodies->column[0] = aligned_alloc(SOFT_ALIGN, room * CORNER_COLUMNS * sizeof(float));
    if (bodies->column[0] == NULL)
        return -1;
    bodies->column_room = room;
    for (uint32_t k = 1; k < CORNER_COLUMNS; k++)
        bodies->column[k] = bodies->column[0] + room * k;
    return 0;
}

/* Allocates the list of meshes. Each mesh is built when it is first needed: one picture needs few
 * of them, and building all takes a quarter of a second. */
static int room_for_meshes(struct soft_bodies *bodies)
{
    bodies->meshes = bodies->static_scene->world->counts.models * MESH_DETAIL_COUNT;
    bodies->mesh = calloc(bodies->meshes + 1, sizeof *bodies->mesh);
    bodies->built = calloc(bodies->meshes + 1, sizeof *bodies->built);
    return bodies->mesh == NULL || bodies->built == NULL ? -1 : 0;
}

struct soft_bodies *soft_bodies_open(const struct static_scene *static_scene,
                                     const struct soft_detail *detail, struct error_text *error)
{
    struct soft_bodies *bodies = calloc(1, sizeof *bodies);
    if (bodies != NULL) {
        bodies->static_scene = static_scene;
        bodies->detail = detail;
        if (room_for_meshes(bodies) == 0)
            return bodies;
    }
    soft_bodies_close(bodies);
    error_text_set(error, "no memory for the bodies");
    return NULL;
}

static void free_faces(struct soft_faces *faces)
{
    band_lists_free(&faces->lists);
    free(faces->list);
    free(faces->rows);
}

void soft_bodies_close(struct soft_bodies *bodies)
{
    if (bodies == NULL)
        return;
    for (uint32_t i = 0; bodies->mesh != NULL && i < bodies->meshes; i++)
        soft_mesh_close(&bodies->mesh[i]);
    free_faces(&bodies->flat_faces);
    free_faces(&bodies->textured_faces);
    free_faces(&bodies->shadow_faces);
    free(bodies->mesh);
    free(bodies->built);
    free(bodies->column[0]);
    free(bodies->materials);
    free(bodies);
}

/* --- a picture -------------------------------------------------------------------------------- */

struct soft_bounds soft_bodies_bounds(const struct soft_bodies *bodies,
                                      const struct soft_frame *frame, uint32_t index)
{
    const struct draw_list_body *body = &frame->list->bodies[index];
    const struct mesh_skeleton *box =
        &bodies->static_scene->skeletons[frame->list->instances[index].model];
    const float *f = body->forward, *at = body->at;
    float scale = f[0] * f[0] + f[1] * f[1] + f[2] * f[2], reach = 0.0f;
    for (uint32_t axis = 0; axis < 3; axis++) {
        float most = fmaxf(-box->low[axis], box->high[axis]);
        reach += most * most;
    }
    struct soft_bounds r = {.metres = REACH_SPARE * sqrtf(reach * scale),
                            .ahead = frame->ahead[0] * at[0] + frame->ahead[1] * at[1] +
                                     frame->ahead[2] * at[2]};
    r.pixels = 2.0f * r.metres / (frame->pixel_m * fmaxf(r.ahead - r.metres, frame->near_m));
    return r;
}

/* Allocates for this many faces, each of which the near plane may cut into two triangles. */
static int face_room(struct soft_faces *faces, size_t count, size_t size)
{
    void *rows = faces->rows;
    int failed = band_lists_reserve(&faces->list, &faces->list_room, 2 * count, size);
    failed |= band_lists_reserve(&rows, &faces->row_room, 2 * count, sizeof *faces->rows);
    faces->rows = rows;
    faces->count = 0;
    return failed;
}

static int sort_faces(struct soft_faces *faces, uint32_t bands)
{
    return band_lists_sort(&faces->lists, faces->rows, faces->count, bands);
}

int soft_bodies_prepare(struct soft_bodies *bodies, const struct soft_frame *frame)
{
    const struct draw_list *list = frame->list;
    size_t flat_faces = 0, textured_faces = 0, shadow_faces = 0;
    for (uint32_t i = 0; i < list->body_count; i++) {
        const struct draw_list_instance *instance = &list->instances[i];
        uint32_t which = instance->model * (uint32_t)MESH_DETAIL_COUNT + instance->detail;
        if (!bodies->built[which] && build_mesh(bodies, which) != 0)
            return -1;
        uint32_t faces = bodies->mesh[which].face_count;
        if (soft_bodies_bounds(bodies, frame, i).pixels < TEXTURED_PIXELS_MIN)
            flat_faces += faces;
        else
            textured_faces += faces;
        shadow_faces += instance->shadow ? faces : 0;
    }
    void *materials = bodies->materials;
    int failed = band_lists_reserve(&materials, &bodies->material_room, list->body_count,
                                    sizeof *bodies->materials);
    bodies->materials = materials;
    bodies->material_count = 0;
    if (failed != 0 ||
        face_room(&bodies->flat_faces, flat_faces, sizeof(struct soft_flat_face)) != 0 ||
        face_room(&bodies->textured_faces, textured_faces, sizeof(struct soft_textured_face)) !=
            0 ||
        face_room(&bodies->shadow_faces, shadow_faces, sizeof(struct soft_shadow_face)) != 0)
        return -1;
    frame->kernels->soft_bodies_set_up(bodies, frame);
    if (sort_faces(&bodies->flat_faces, frame->bands) != 0 ||
        sort_faces(&bodies->textured_faces, frame->bands) != 0)
        return -1;
    return sort_faces(&bodies->shadow_faces, frame->bands);
}
