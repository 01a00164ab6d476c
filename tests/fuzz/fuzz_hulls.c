/* Hulls of arbitrary triangles: corners on a few planes, in a line, in one point, a micrometre or a
 * kilometre apart. These are meshes as a file could have them, without the file. */
#include "tests/fuzz/support.h"

#include "config/mesh/hulls.h"
#include "ipc/process/log.h"
#include "world/making/scenario.h"
#include "world/model.h"
#include "world/runtime/check.h"

#include <stdlib.h>
#include <string.h>

#define VERTICES_MAX (3u + UINT8_MAX / 4u)

/* Metres for each step of a coordinate, which has -128..127 steps. */
static const float scales[] = {1e-6f, 3e-5f, 0.001f, 0.02f, 0.3f, 1.0f, 7.8f};

static uint8_t next(const uint8_t **data, size_t *size)
{
    if (*size == 0)
        return 0;
    --*size;
    return *(*data)++;
}

/* The first byte is the number of vertices. Each vertex has three bytes, and the remaining bytes
 * are triangles. */
static void take_model(struct scenario *s, struct model *model, const uint8_t *data, size_t size)
{
    float scale = scales[next(&data, &size) % (sizeof scales / sizeof scales[0])];
    float offset = next(&data, &size) % 2 != 0 ? 3.0f : 0.0f;
    uint32_t count = 3u + next(&data, &size) / 4u;
    s->vertices = calloc(VERTICES_MAX, sizeof *s->vertices);
    s->triangles = calloc(size / 3 + 1, sizeof *s->triangles);
    CHECK(s->vertices && s->triangles && count <= VERTICES_MAX);
    for (uint32_t i = 0; i < count; i++) {
        float *to[] = {&s->vertices[i].x, &s->vertices[i].y, &s->vertices[i].z};
        for (int k = 0; k < 3; k++)
            *to[k] = offset + scale * (float)(int8_t)next(&data, &size);
    }
    s->vertex_count = model->vertex_count = count;
    while (size >= 3) {
        struct model_triangle *triangle = &s->triangles[s->triangle_count++];
        for (int k = 0; k < 3; k++)
            triangle->vertex[k] = next(&data, &size) % count;
    }
    model->triangle_count = s->triangle_count;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct scenario scenario = {0};
    struct error_text error = {0};
    struct hulls hulls;
    scenario.models = calloc(1, sizeof *scenario.models);
    CHECK(scenario.models);
    scenario.model_count = 1;
    take_model(&scenario, &scenario.models[0], data, size);
    if (hulls_build(&hulls, &scenario, &scenario.models[0], (struct key_place){"fuzz", 0},
                    &error) == 0)
        support_check_model(&scenario, 0, &hulls);
    else
        support_check_message(&error);
    scenario_free(&scenario);
    return 0;
}
