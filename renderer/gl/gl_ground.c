/* The ground in OpenGL: the tiles of the cache, each sent to the driver when it has changed. */
#include "renderer/gl/gl_internal.h"

#include "renderer/scene/frame/light.h"

#include <math.h>
#include <string.h>

static const char vertex_text[] =
    "layout(location = 0) in vec3 a_place;\n"
    "uniform vec4 u_origin;\n"    /* the patch's corner from the eye [m]; its side */
    "uniform vec4 u_detail_at;\n" /* the corner in the detail texture and in the waves [period] */
    "uniform vec3 u_part;\n"      /* the part of the ground texture: its corner, its side */
    "out vec2 v_tile, v_fine, v_waves;\n"
    "out vec3 v_place;\n"
    "out vec4 v_air;\n"
    "const float texels = 128.0;\n"
    "void main()\n"
    "{\n"
    "    vec3 place = u_origin.xyz + a_place;\n"
    "    gl_Position = u_matrix * vec4(place, 1.0);\n"
    /* The first and last texel lie on the patch's edges, so that neighbours have the same colour
     * there. */
    "    vec2 at = u_part.xy + a_place.xz * (u_part.z / u_origin.w);\n"
    "    v_tile = (at * (texels - 1.0) + 0.5) / texels;\n"
    "    v_fine = u_detail_at.xy + a_place.xz / FINE_M;\n"
    "    v_waves = u_detail_at.zw + vec2(a_place.x + 0.35 * a_place.z,\n"
    "                                    a_place.z - 0.35 * a_place.x) / WAVES_M;\n"
    "    v_place = place;\n"
    "    v_air = air(place);\n"
    "}\n";

/* Software OpenGL executes every branch of a shader. Ground without water therefore has a shader of
 * its own, at a fifth of the cost. */
#define LAND                                                                                       \
    "uniform sampler2D u_tile, u_detail;\n"                                                        \
    "uniform float u_texel_m;\n"                                                                   \
    "in vec2 v_tile, v_fine, v_waves;\n"                                                           \
    "in vec3 v_place;\n"                                                                           \
    "in vec4 v_air;\n"                                                                             \
    "out vec4 o_colour;\n" /* The mip is that of tile_texels(); the filter rounds it to the        \
                              nearest. */                                                          \
    "vec4 painting()\n"                                                                            \
    "{\n"                                                                                          \
    "    float covers = max(length(dFdx(v_place)), length(dFdy(v_place)));\n"                      \
    "    float wanted = max(length(v_place) * TILE_WANTED, covers * TILE_COVERED);\n"              \
    "    return textureLod(u_tile, v_tile, log2(wanted / u_texel_m) - 0.35);\n"                    \
    "}\n"                                                                                          \
    "vec3 textured(vec4 tile)\n"                                                                   \
    "{\n"                                                                                          \
    "    vec2 fine = texture(u_detail, v_fine).rg;\n"                                              \
    "    float scrub = clamp((tile.a - 0.376) / 0.624, 0.0, 1.0);\n"                               \
    "    float left = clamp((FINE_FADED_M - length(v_place)) / (FINE_FADED_M - FINE_FADES_M),\n"   \
    "                       0.0, 1.0) * u_sun.w;\n"                                                \
    "    float shade = 1.0 + left * (mix(fine.r, fine.g, scrub) - 0.5);\n"                         \
    "    return tile.rgb * shade;\n"                                                               \
    "}\n"

static const char land_text[] = LAND "void main()\n"
                                     "{\n"
                                     "    vec3 colour = textured(painting());\n"
                                     "    o_colour = vec4(mix(colour, v_air.rgb, v_air.a), 1.0);\n"
                                     "}\n";

static const char shore_text[] =
    LAND "uniform float u_surf;\n"
         "void main()\n"
         "{\n"
         "    vec4 tile = painting();\n"
         "    float far = length(v_place);\n"
         "    vec2 near_w = texture(u_detail, v_waves * 5.7 + 0.023 * u_forward.w).rg;\n"
         "    vec2 broad_w = texture(u_detail, v_waves.yx * 1.7 - 0.007 * u_forward.w).rg;\n"
         "    vec2 w = near_w + broad_w - 1.0;\n"
         "    vec3 way = v_place / far;\n"
         "    float calm = WAVE_STEEP * u_sun.w * WAVE_HALF_M / (WAVE_HALF_M + far);\n"
         "    vec3 n = normalize(vec3(w.x * calm, 1.0, w.y * calm));\n"
         "    vec3 back = reflect(way, n);\n"
         "    back.y = max(back.y, 0.0);\n"
         "    float grazing = 1.0 - max(dot(-way, n), 0.0);\n"
         "    float mirror = 0.04 + 0.80 * grazing * grazing * grazing * grazing;\n"
         "    float glint = max(dot(back, u_sun.xyz), 0.0);\n"
         "    back.y += WAVE_LIFT;\n"
         "    vec3 water = mix(tile.rgb, sky(back), mirror);\n"
         "    glint *= glint;\n" /* to the power of 128 */
         "    glint *= glint;\n"
         "    glint *= glint;\n"
         "    glint *= glint;\n"
         "    glint *= glint;\n"
         "    glint *= glint;\n"
         "    glint *= glint;\n"
         "    water += sun_light * glint * 1.6;\n"
         /* There are two lines of foam that come and go, and the wash at the water's edge. */
         "    float shore = clamp(tile.a / SHORE_WATER, 0.0, 1.0);\n"
         "    float beat = abs(2.0 * fract(u_forward.w / SURF_S) - 1.0);\n"
         "    beat = beat * beat * (3.0 - 2.0 * beat);\n"
         "    float line = shore - 0.29 - 0.32 * beat - 0.5 * broad_w.x;\n"
         "    float foam = max(1.0 - 7.0 * abs(line), 0.0);\n"
         "    foam += 0.5 * max(1.0 - 6.0 * abs(line + 0.34), 0.0);\n"
         "    foam = max(foam, 5.0 * (shore - 0.86)) * (0.3 + 1.2 * near_w.y);\n"
         "    foam *= u_surf * clamp(3.0 * shore - 0.4, 0.0, 1.0);\n"
         "    water = mix(water, FOAM_WHITE, clamp(foam, 0.0, 0.9));\n"
         "    vec3 colour = mix(water, textured(tile),\n"
         "                      smoothstep(SHORE_WATER, SHORE_GROUND, tile.a));\n"
         "    o_colour = vec4(mix(colour, v_air.rgb, v_air.a), 1.0);\n"
         "}\n";

static void open_tile(struct gl_tile *tile)
{
    glGenVertexArrays(1, &tile->array);
    glBindVertexArray(tile->array);
    glGenBuffers(1, &tile->triangles);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, tile->triangles);
    glGenBuffers(1, &tile->vertices);
    glBindBuffer(GL_ARRAY_BUFFER, tile->vertices);
    gl_attribute(0, 3, 3 * sizeof(float), 0, 0);
    glGenTextures(1, &tile->texture);
    glBindTexture(GL_TEXTURE_2D, tile->texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

static int open_shader(struct gl_ground_shader *shader, const char *name, const char *fragment,
                       struct error_text *error)
{
    shader->program = gl_program(name, vertex_text, fragment, error);
    if (shader->program == 0)
        return -1;
    shader->u_origin = glGetUniformLocation(shader->program, "u_origin");
    shader->u_detail = glGetUniformLocation(shader->program, "u_detail_at");
    shader->u_part = glGetUniformLocation(shader->program, "u_part");
    shader->u_surf = glGetUniformLocation(shader->program, "u_surf");
    shader->u_texel = glGetUniformLocation(shader->program, "u_texel_m");
    return 0;
}

int gl_ground_open(struct gl_ground *ground, const struct static_scene *static_scene,
                   struct error_text *error)
{
    memset(ground, 0, sizeof *ground);
    ground->static_scene = static_scene;
    if (terrain_tiles_init(&ground->cache) != 0)
        return error_text_set(error, "no memory for the ground");
    if (open_shader(&ground->land, "ground", land_text, error) == 0 &&
        open_shader(&ground->shore, "water", shore_text, error) == 0)
        return 0;
    gl_ground_close(ground);
    return -1;
}

void gl_ground_close(struct gl_ground *ground)
{
    for (uint32_t i = 0; i < TILE_CAPACITY; i++) {
        glDeleteVertexArrays(1, &ground->tiles[i].array);
        glDeleteBuffers(1, &ground->tiles[i].vertices);
        glDeleteBuffers(1, &ground->tiles[i].triangles);
        glDeleteTextures(1, &ground->tiles[i].texture);
    }
    glDeleteProgram(ground->land.program);
    glDeleteProgram(ground->shore.program);
    terrain_tiles_free(&ground->cache);
}

/* Returns the driver's copy of a tile. */
static struct gl_tile *copy_of(struct gl_ground *ground, const struct tile *tile)
{
    struct gl_tile *copy = &ground->tiles[terrain_tiles_index(&ground->cache, tile)];
    if (copy->array == 0)
        open_tile(copy);
    return copy;
}

static void send_mesh(struct gl_ground *ground, const struct tile *tile)
{
    struct gl_tile *copy = copy_of(ground, tile);
    if (copy->mesh_version == tile->mesh_version)
        return;
    copy->mesh_version = tile->mesh_version;
    glBindBuffer(GL_ARRAY_BUFFER, copy->vertices);
    const struct terrain_mesh *mesh = &tile->mesh;
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(mesh->vertex_count * sizeof mesh->vertices[0]),
                 mesh->vertices, GL_STATIC_DRAW);
    glBindVertexArray(copy->array);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 (GLsizeiptr)(mesh->triangle_count * sizeof mesh->triangles[0]), mesh->triangles,
                 GL_STATIC_DRAW);
}

static void send_texture(struct gl_ground *ground, const struct tile *tile)
{
    struct gl_tile *copy = copy_of(ground, tile);
    if (copy->texture_version == tile->texture_version)
        return;
    copy->texture_version = tile->texture_version;
    glBindTexture(GL_TEXTURE_2D, copy->texture);
    for (uint32_t mip = 0; mip < TILE_MIPS; mip++)
        glTexImage2D(GL_TEXTURE_2D, (GLint)mip, GL_RGBA8, (GLsizei)tile_mip_side(mip),
                     (GLsizei)tile_mip_side(mip), 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     tile->texture + tile_mip_offset(mip));
}

static float fraction(double v)
{
    return (float)(v - floor(v));
}

static void draw_view(struct gl_ground *ground, const struct gl_ground_shader *shader,
                      const struct draw_list *list, const struct tile_view *view)
{
    const struct tile_key *key = &view->tile->key;
    double side = terrain_quadtree_patch_side(key->level);
    double x = key->column * side, z = key->row * side;
    float corner[3];
    draw_list_relative(list, (struct vec3){x, 0.0, z}, corner);
    glUniform4f(shader->u_origin, corner[0], corner[1], corner[2], (float)side);
    glUniform3f(shader->u_part, view->at_u, view->at_v, view->share);
    glUniform1f(shader->u_surf, view->texture_tile->surf ? 1.0f : 0.0f);
    glUniform1f(shader->u_texel, (float)(side / (TILE_TEXELS - 1)) / view->share);
    double fine = (double)FINE_M, waves = (double)WAVES_M;
    glUniform4f(shader->u_detail, fraction(x / fine), fraction(z / fine),
                fraction((x + 0.35 * z) / waves), fraction((z - 0.35 * x) / waves));
    glBindTexture(GL_TEXTURE_2D, copy_of(ground, view->texture_tile)->texture);
    glBindVertexArray(copy_of(ground, view->tile)->array);
    glDrawElements(GL_TRIANGLES, (GLsizei)(3 * view->tile->mesh.triangle_count), GL_UNSIGNED_SHORT,
                   NULL);
}

void gl_ground_draw(struct gl_ground *ground, const struct draw_list *list,
                    const struct frame_view *frame_view)
{
    struct terrain_tiles *cache = &ground->cache;
    terrain_tiles_update(cache, list->patches, list->patch_count, frame_view, list->texture_budget);
    glEnable(GL_CULL_FACE);
    glActiveTexture(GL_TEXTURE0 + UNIT_TILE);
    for (uint32_t i = 0; i < cache->view_count; i++) {
        const struct tile_view *view = &cache->views[i];
        const struct gl_ground_shader *shader =
            view->texture_tile->wet ? &ground->shore : &ground->land;
        send_mesh(ground, view->tile);
        send_texture(ground, view->texture_tile);
        glUseProgram(shader->program);
        draw_view(ground, shader, list, view);
    }
    glDisable(GL_CULL_FACE);
}
