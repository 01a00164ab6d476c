/* Bodies in OpenGL. Each mesh is drawn once for all its instances, and a second time, flattened
 * onto the ground, for their shadows. */
#include "renderer/gl/gl_internal.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define SHADOW_COLOUR "vec4(0.05, 0.06, 0.09, 0.50)"

static const char vertex_text[] =
    "uniform float u_low;\n"
    "out vec3 v_body, v_light;\n"
    "out vec4 v_colour, v_air;\n"
    "out vec2 v_link;\n"
    "out float v_burn, v_fell, v_bare;\n"
    "void main()\n"
    "{\n"
    "    vec3 rolling = rolled(a_place, 1.0);\n"
    "    vec3 place = formed(rolling), normal = rolled(a_normal, 0.0);\n"
    /* A deformed surface has other normals. */
    "    if (i_form.y > 0.5 || i_falls.z > 0.0 || i_broken.z > 0.0) {\n"
    "        vec3 along = normalize(cross(normal, abs(normal.y) < 0.8 ? vec3(0.0, 1.0, 0.0)\n"
    "                                                               : vec3(1.0, 0.0, 0.0)));\n"
    "        vec3 u = formed(rolling + 0.04 * along) - place;\n"
    "        vec3 v = formed(rolling + 0.04 * cross(normal, along)) - place;\n"
    "        vec3 facing = cross(u, v);\n"
    "        normal = dot(facing, facing) > 1e-12 ? normalize(facing) : normal;\n"
    "    }\n"
    "    place = turned(place, 1.0);\n"
    "    normal = turned(normal, 0.0);\n"
    "    vec4 pivot = u_pivots[int(a_part.y + 0.5)];\n"
    "    v_link = a_part.x > 6.5 ? vec2(a_along + way(pivot), 1.0) : vec2(0.0);\n"
    "    vec3 world = i_at + in_world(place);\n"
    "    vec3 n = normalize(in_world(normal));\n"
    "    gl_Position = u_matrix * vec4(world, 1.0);\n"
    "    float sun = max(dot(n, u_sun.xyz), 0.0);\n"
    /* The sky lights surfaces that face up, the ground reflects a little, and both are weaker low
     * under a body. */
    "    float open = mix(0.55, 1.0, smoothstep(0.0, 1.3, place.y - u_low));\n"
    "    vec3 sky_part = mix(vec3(0.36, 0.31, 0.24), sky_light * 1.12, 0.5 + 0.5 * n.y);\n"
    "    v_light = sky_part * open + sun_light * sun * mix(0.8, 1.0, open);\n"
    "    vec3 back = reflect(normalize(world), n);\n"
    "    v_light += 0.16 * sun_light * pow(max(dot(back, u_sun.xyz), 0.0), 12.0);\n"
    "    v_colour = a_colour;\n"
    "    v_colour.rgb = mix(a_colour.rgb, i_tint.rgb * (0.55 + 0.9 * dot(a_colour.rgb,\n"
    "                       vec3(0.333))), 0.85 * a_colour.a);\n"
    "    v_body = a_place;\n"
    "    v_burn = i_tint.a;\n"
    "    v_bare = i_form.y > 0.5 ? min(length(dented(rolling) - rolling) * 4.0, 1.0) : 0.0;\n"
    "    v_fell = i_falls.z > 0.0 ? fell(a_place) : 0.0;\n"
    "    v_air = air(world);\n"
    "}\n";

static const char fragment_text[] =
    "uniform sampler2D u_detail;\n"
    "in vec3 v_body, v_light;\n"
    "in vec4 v_colour, v_air;\n"
    "in vec2 v_link;\n"
    "in float v_burn, v_fell, v_bare;\n"
    "out vec4 o_colour;\n"
    "void main()\n"
    "{\n"
    "    vec3 colour = v_colour.rgb;\n"
    /* A track's links alternate between light and dark until they are narrower than pixels. */
    "    float link = smoothstep(0.1, 0.3, abs(fract(0.5 * v_link.x) - 0.5));\n"
    "    link = mix(link, 0.5, clamp(2.0 * fwidth(v_link.x) - 0.5, 0.0, 1.0));\n"
    "    colour *= mix(1.0, 0.55 + 0.9 * link, v_link.y);\n"
    /* A dented surface shows bare metal. (The level of detail is undefined in a branch that not all
     * pixels take.) */
    "    if (v_bare > 0.0) {\n"
    "        float scrape = textureLod(u_detail, v_body.xy * 0.9 + v_body.z, 0.0).g;\n"
    "        colour = mix(colour, vec3(0.30, 0.285, 0.27) * (0.5 + scrape),\n"
    "                     0.85 * smoothstep(1.0 - v_bare, 1.25 - v_bare, scrape + 0.15));\n"
    "    }\n"
    /* A collapsed body has its own colour, dust, and dark gaps. */
    "    if (v_fell > 0.0) {\n"
    "        vec2 at = v_body.xz + 0.7 * v_body.y;\n"
    "        float lump = textureLod(u_detail, at * 0.21, 0.0).g;\n"
    "        float gap = textureLod(u_detail, at * 0.43, 0.0).r;\n"
    "        vec3 dust = vec3(0.60, 0.53, 0.43) * (0.7 + 0.5 * gap);\n"
    "        vec3 rubble = mix(colour, dust, smoothstep(0.36, 0.52, lump));\n"
    "        rubble *= mix(0.35, 1.0, smoothstep(0.34, 0.50, gap));\n"
    /* Earth lies between the standing and the collapsed part. */
    "        float torn = smoothstep(0.01, 0.15, v_fell) * (1.0 - smoothstep(0.85, 1.0, v_fell));\n"
    "        vec3 earth = vec3(0.42, 0.35, 0.27) * (0.55 + 0.9 * lump * gap);\n"
    "        colour = mix(mix(colour, rubble, smoothstep(0.5, 1.0, v_fell)), earth, 0.92 * torn);\n"
    "    }\n"
    "    if (u_sun.w > 0.5) {\n"
    "        vec2 at = vec2(v_body.x + 0.45 * v_body.y, v_body.z + 0.8 * v_body.y);\n"
    "        vec2 blot = texture(u_detail, at * 0.035).rg;\n"
    "        vec2 fine = texture(u_detail, at * 0.31).rg;\n"
    "        float patch_dark = smoothstep(0.46, 0.54, blot.r) * step(0.29, v_colour.a) * "
    "step(v_colour.a, 0.6);\n"
    "        colour *= 1.0 - 0.30 * patch_dark;\n"
    "        colour *= 0.86 + 0.28 * fine.r;\n"
    /* Soot lies in patches with soft edges and never fully covers a body that still works. */
    "        float soot = smoothstep(1.12 - 1.15 * v_burn, 1.54 - 1.15 * v_burn,\n"
    "                                fine.g + 0.3 * blot.g);\n"
    "        soot *= min(0.5 + 0.8 * v_burn, 1.0) * smoothstep(0.0, 0.1, v_burn);\n"
    "        vec3 burnt = mix(vec3(0.055, 0.05, 0.047), vec3(0.20, 0.115, 0.07),\n"
    "                         smoothstep(0.60, 0.80, fine.g + 0.4 * (blot.g - 0.5)) * 0.8 * "
    "step(0.9, v_burn));\n"
    "        colour = mix(colour, burnt, max(soot, 0.94 * smoothstep(0.8, 1.0, v_burn)));\n"
    "    } else {\n"
    "        colour = mix(colour, vec3(0.07), v_burn * 0.9);\n"
    "    }\n"
    "    o_colour = vec4(mix(colour * v_light, v_air.rgb, v_air.a), 1.0);\n"
    "}\n";

static const char shadow_vertex_text[] =
    "out float v_clear;\n"
    "void main()\n"
    "{\n"
    "    if (dot(i_plane.xyz, i_plane.xyz) < 0.5) {\n"
    "        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);\n"
    "        v_clear = 0.0;\n"
    "        return;\n"
    "    }\n"
    "    vec3 place = turned(formed(rolled(a_place, 1.0)), 1.0);\n"
    "    vec3 world = i_at + in_world(place);\n"
    "    float down = (dot(i_plane.xyz, world) - i_plane.w) / dot(i_plane.xyz, u_sun.xyz);\n"
    "    world -= u_sun.xyz * max(down, 0.0);\n"
    "    gl_Position = u_matrix * vec4(world, 1.0);\n"
    "    v_clear = 1.0 - air(world).a;\n"
    "}\n";

static const char shadow_fragment_text[] = "in float v_clear;\n"
                                           "out vec4 o_colour;\n"
                                           "void main()\n"
                                           "{\n"
                                           "    vec4 shade = " SHADOW_COLOUR ";\n"
                                           "    o_colour = vec4(shade.rgb, shade.a * v_clear);\n"
                                           "}\n";

/* Sends all meshes of all models in one buffer. Returns 0, or -1 with errno. */
static int send_meshes(struct gl_bodies *bodies)
{
    const struct world *world = bodies->static_scene->world;
    struct mesh_vertex *all = NULL;
    size_t count = 0;
    for (uint32_t model = 0; model < world->counts.models; model++)
        for (uint32_t detail = 0; detail < MESH_DETAIL_COUNT; detail++) {
            struct mesh mesh;
            if (mesh_build(&mesh, world, model, (enum mesh_detail)detail) != 0)
                goto err_all;
            struct mesh_vertex *grown = realloc(all, (count + mesh.count + 1) * sizeof *all);
            if (grown == NULL) {
                mesh_free(&mesh);
                goto err_all;
            }
            all = grown;
            if (mesh.count > 0)
                memcpy(all + count, mesh.vertices, mesh.count * sizeof *all);
            bodies->mesh[model * MESH_DETAIL_COUNT + detail] =
                (struct gl_mesh){(GLint)count, (GLsizei)mesh.count};
            count += mesh.count;
            mesh_free(&mesh);
        }
    glBindBuffer(GL_ARRAY_BUFFER, bodies->meshes);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(count * sizeof *all), all, GL_STATIC_DRAW);
    free(all);
    return 0;

err_all:
    free(all);
    return -1;
}

static void describe_vertices(const struct gl_bodies *bodies)
{
    size_t stride = sizeof(struct mesh_vertex);
    glBindBuffer(GL_ARRAY_BUFFER, bodies->meshes);
    gl_attribute(0, 3, stride, offsetof(struct mesh_vertex, position), 0);
    gl_attribute(1, 3, stride, offsetof(struct mesh_vertex, normal), 0);
    glEnableVertexAttribArray(2);
    glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, (GLsizei)stride,
                          (const void *)(uintptr_t)offsetof(struct mesh_vertex, red));
    glEnableVertexAttribArray(3);
    glVertexAttribPointer(3, 2, GL_UNSIGNED_SHORT, GL_FALSE, (GLsizei)stride,
                          (const void *)(uintptr_t)offsetof(struct mesh_vertex, part));
    gl_attribute(15, 1, stride, offsetof(struct mesh_vertex, along), 0);
}

/* Points the instances' attributes at the first of a batch, since OpenGL 3.3 has no base
 * instance. */
static void describe_copies(const struct gl_bodies *bodies, uint32_t first)
{
    size_t stride = sizeof(struct draw_list_body), base = first * stride;
    glBindBuffer(GL_ARRAY_BUFFER, bodies->instances);
    gl_attribute(4, 3, stride, base + offsetof(struct draw_list_body, at), 1);
    gl_attribute(5, 3, stride, base + offsetof(struct draw_list_body, forward), 1);
    gl_attribute(6, 3, stride, base + offsetof(struct draw_list_body, up), 1);
    gl_attribute(7, 3, stride, base + offsetof(struct draw_list_body, right), 1);
    gl_attribute(8, 4, stride, base + offsetof(struct draw_list_body, tint), 1);
    gl_attribute(9, 4, stride, base + offsetof(struct draw_list_body, turret_rad), 1);
    gl_attribute(10, 4, stride, base + offsetof(struct draw_list_body, plane), 1);
    gl_attribute(11, 3, stride, base + offsetof(struct draw_list_body, dents), 1);
    gl_attribute(12, 3, stride, base + offsetof(struct draw_list_body, collapse), 1);
    gl_attribute(13, 3, stride, base + offsetof(struct draw_list_body, broken), 1);
    gl_attribute(14, 2, stride, base + offsetof(struct draw_list_body, travel_m), 1);
}

static void open_dents(struct gl_bodies *bodies)
{
    glGenBuffers(1, &bodies->dents);
    glBindBuffer(GL_TEXTURE_BUFFER, bodies->dents);
    glBufferData(GL_TEXTURE_BUFFER, sizeof(struct draw_list_dent), NULL, GL_STREAM_DRAW);
    glGenTextures(1, &bodies->dent_texture);
    glActiveTexture(GL_TEXTURE0 + UNIT_DENTS);
    glBindTexture(GL_TEXTURE_BUFFER, bodies->dent_texture);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, bodies->dents);
}

int gl_bodies_open(struct gl_bodies *bodies, const struct static_scene *static_scene,
                   struct error_text *error)
{
    *bodies = (struct gl_bodies){.static_scene = static_scene};
    bodies->program = gl_program_on("body", gl_deform_text, vertex_text, fragment_text, error);
    if (bodies->program == 0)
        return -1;
    bodies->shadow_program = gl_program_on("body shadow", gl_deform_text, shadow_vertex_text,
                                           shadow_fragment_text, error);
    if (bodies->shadow_program == 0)
        goto err_program;
    bodies->u_pivots = glGetUniformLocation(bodies->program, "u_pivots");
    bodies->u_low = glGetUniformLocation(bodies->program, "u_low");
    bodies->u_shadow_pivots = glGetUniformLocation(bodies->shadow_program, "u_pivots");
    size_t meshes = (size_t)static_scene->world->counts.models * MESH_DETAIL_COUNT;
    bodies->mesh = calloc(meshes + 1, sizeof *bodies->mesh);
    glGenVertexArrays(1, &bodies->array);
    glBindVertexArray(bodies->array);
    glGenBuffers(1, &bodies->meshes);
    glGenBuffers(1, &bodies->instances);
    open_dents(bodies);
    if (bodies->mesh == NULL || send_meshes(bodies) != 0) {
        gl_bodies_close(bodies);
        return error_text_set(error, "no memory for the models");
    }
    describe_vertices(bodies);
    return 0;

err_program:
    glDeleteProgram(bodies->program);
    return -1;
}

void gl_bodies_close(struct gl_bodies *bodies)
{
    glDeleteProgram(bodies->program);
    glDeleteProgram(bodies->shadow_program);
    glDeleteVertexArrays(1, &bodies->array);
    glDeleteBuffers(1, &bodies->meshes);
    glDeleteBuffers(1, &bodies->instances);
    glDeleteTextures(1, &bodies->dent_texture);
    glDeleteBuffers(1, &bodies->dents);
    free(bodies->mesh);
}

void gl_bodies_send(struct gl_bodies *bodies, const struct draw_list *list)
{
    glBindBuffer(GL_ARRAY_BUFFER, bodies->instances);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(list->body_count * sizeof *list->bodies),
                 list->bodies, GL_STREAM_DRAW);
    glBindBuffer(GL_TEXTURE_BUFFER, bodies->dents);
    if (list->dent_count > 0)
        glBufferData(GL_TEXTURE_BUFFER, (GLsizeiptr)(list->dent_count * sizeof *list->dents),
                     list->dents, GL_STREAM_DRAW);
}

static bool same_mesh(const struct draw_list_instance *a, const struct draw_list_instance *b)
{
    return a->model == b->model && a->detail == b->detail;
}

/* Draws each run of instances of one mesh. */
static void draw_runs(const struct gl_bodies *bodies, const struct draw_list *list, GLint u_pivots,
                      GLint u_low)
{
    glBindVertexArray(bodies->array);
    for (uint32_t first = 0, end; first < list->body_count; first = end) {
        const struct draw_list_instance *instance = &list->instances[first];
        for (end = first + 1; end < list->body_count; end++)
            if (!same_mesh(instance, &list->instances[end]))
                break;
        const struct gl_mesh *mesh =
            &bodies->mesh[(size_t)instance->model * MESH_DETAIL_COUNT + instance->detail];
        const struct mesh_skeleton *skeleton = &bodies->static_scene->skeletons[instance->model];
        glUniform4fv(u_pivots, MODEL_JOINTS_MAX, &skeleton->pivot[0][0]);
        if (u_low >= 0)
            glUniform1f(u_low, skeleton->low[1]);
        describe_copies(bodies, first);
        glDrawArraysInstanced(GL_TRIANGLES, mesh->first, mesh->count, (GLsizei)(end - first));
    }
}

void gl_bodies_draw_shadows(struct gl_bodies *bodies, const struct draw_list *list)
{
    glUseProgram(bodies->shadow_program);
    draw_runs(bodies, list, bodies->u_shadow_pivots, -1);
}

void gl_bodies_draw(struct gl_bodies *bodies, const struct draw_list *list)
{
    glUseProgram(bodies->program);
    draw_runs(bodies, list, bodies->u_pivots, bodies->u_low);
}
