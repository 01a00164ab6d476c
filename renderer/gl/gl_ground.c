/* The ground in OpenGL: a bounded set of patches, each with its mesh and its own painting, made
 * when they come into view and given up when longest unseen. */
#include "renderer/gl/gl.h"

#include "renderer/scene/light.h"
#include "renderer/scene/paint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DETAIL_M 19.0  /* the fine texture's period */
#define BROAD_M  131.0 /* and of its second use, which hides that the first repeats */

static const char vertex_text[] =
    "layout(location = 0) in vec3 a_place;\n"
    "uniform vec4 u_origin;\n"    /* the patch's corner from the eye; its side */
    "uniform vec4 u_detail_at;\n" /* the corner in fine and in broad texture; a metre in each */
    "out vec2 v_tile, v_fine, v_broad;\n"
    "out vec3 v_place;\n"
    "out vec4 v_air;\n"
    "const float texels = 128.0;\n"
    "void main()\n"
    "{\n"
    "    vec3 place = u_origin.xyz + a_place;\n"
    "    gl_Position = u_matrix * vec4(place, 1.0);\n"
    /* The first and last texel lie on the patch's edges: neighbours meet in the same colour. */
    "    v_tile = (a_place.xz / u_origin.w * (texels - 1.0) + 0.5) / texels;\n"
    "    v_fine = u_detail_at.xy + a_place.xz / 19.0;\n"
    "    v_broad = u_detail_at.zw + vec2(a_place.x + 0.35 * a_place.z,\n"
    "                                    a_place.z - 0.35 * a_place.x) / 131.0;\n"
    "    v_place = place;\n"
    "    v_air = air(place);\n"
    "}\n";

/* Software OpenGL runs through every branch of a shader, so ground without water has one of its
 * own, at a fifth of the cost. */
#define LAND                                                                                       \
    "uniform sampler2D u_tile, u_detail;\n"                                                        \
    "in vec2 v_tile, v_fine, v_broad;\n"                                                           \
    "in vec3 v_place;\n"                                                                           \
    "in vec4 v_air;\n"                                                                             \
    "out vec4 o_colour;\n"                                                                         \
    "vec3 textured(vec4 tile)\n"                                                                   \
    "{\n"                                                                                          \
    "    vec2 fine = texture(u_detail, v_fine).rg;\n"                                              \
    "    vec2 broad = texture(u_detail, v_broad).rg;\n"                                            \
    "    float scrub = clamp((tile.a - 0.376) / 0.624, 0.0, 1.0);\n"                               \
    "    float shade = mix(fine.r, fine.g, scrub) + 0.5;\n"                                        \
    "    shade *= 0.62 + 0.76 * mix(broad.r, broad.g, 0.4 * scrub);\n"                             \
    "    return tile.rgb * mix(1.0, shade, u_sun.w);\n"                                            \
    "}\n"

static const char land_text[] = LAND "void main()\n"
                                     "{\n"
                                     "    vec3 colour = textured(texture(u_tile, v_tile));\n"
                                     "    o_colour = vec4(mix(colour, v_air.rgb, v_air.a), 1.0);\n"
                                     "}\n";

static const char shore_text[] =
    LAND "void main()\n"
         "{\n"
         "    vec4 tile = texture(u_tile, v_tile);\n"
         "    vec2 w = texture(u_detail, v_broad * 3.0 + 0.011 * u_forward.w).rg\n"
         "           + texture(u_detail, v_broad - 0.003 * u_forward.w).rg - 1.0;\n"
         "    vec3 way = normalize(v_place);\n"
         "    float calm = 0.22 * u_sun.w / (1.0 + 0.0006 * length(v_place));\n"
         "    vec3 n = normalize(vec3(w.x * calm, 1.0, w.y * calm));\n"
         "    vec3 back = reflect(way, n);\n"
         "    back.y = abs(back.y);\n"
         "    float grazing = 1.0 - max(dot(-way, n), 0.0);\n"
         "    float mirror = 0.04 + 0.80 * grazing * grazing * grazing * grazing;\n"
         "    vec3 water = mix(tile.rgb, sky(back), mirror);\n"
         "    water += sun_light * pow(max(dot(back, u_sun.xyz), 0.0), 120.0) * 1.6;\n"
         "    vec3 colour = mix(water, textured(tile), smoothstep(0.10, 0.30, tile.a));\n"
         "    o_colour = vec4(mix(colour, v_air.rgb, v_air.a), 1.0);\n"
         "}\n";

/* Triangles of all sizes of patches, one after the other in one buffer. */
static void open_triangles(struct gl_ground *ground)
{
    static uint16_t triangles[GROUND_TRIANGLES(GROUND_CELLS_MAX)][3];
    GLintptr offset = 0;
    glGenBuffers(1, &ground->triangles);
    glBindBuffer(GL_COPY_WRITE_BUFFER, ground->triangles);
    /* The sizes are powers of two: together less than twice the largest. */
    glBufferData(GL_COPY_WRITE_BUFFER, 2 * (GLsizeiptr)sizeof triangles, NULL, GL_STATIC_DRAW);
    for (uint32_t cells = 1; cells <= GROUND_CELLS_MAX; cells *= 2) {
        GLsizeiptr bytes = (GLsizeiptr)(GROUND_TRIANGLES(cells) * sizeof triangles[0]);
        ground_triangles(cells, triangles);
        glBufferSubData(GL_COPY_WRITE_BUFFER, offset, bytes, triangles);
        ground->first[cells] = offset;
        offset += bytes;
    }
}

static int open_tiles(struct gl_ground *ground)
{
    open_triangles(ground);
    for (uint32_t i = 0; i < GL_TILES; i++) {
        struct gl_tile *tile = &ground->tiles[i];
        glGenVertexArrays(1, &tile->array);
        glBindVertexArray(tile->array);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, ground->triangles);
        glGenBuffers(1, &tile->vertices);
        glBindBuffer(GL_ARRAY_BUFFER, tile->vertices);
        gl_attribute(0, 3, 3 * sizeof(float), 0, 0);
        glGenTextures(1, &tile->texture);
    }
    size_t texels = (size_t)GL_TILE_TEXELS * GL_TILE_TEXELS;
    ground->rgba = malloc(texels * 4);
    ground->light = malloc(texels * sizeof *ground->light);
    return ground->rgba != NULL && ground->light != NULL ? 0 : -1;
}

static int open_shader(struct gl_ground_shader *shader, const char *name, const char *fragment,
                       struct reason *reason)
{
    shader->program = gl_program(name, vertex_text, fragment, reason);
    if (shader->program == 0)
        return -1;
    shader->u_origin = glGetUniformLocation(shader->program, "u_origin");
    shader->u_detail = glGetUniformLocation(shader->program, "u_detail_at");
    return 0;
}

int gl_ground_open(struct gl_ground *ground, const struct scenery *scenery, struct reason *reason)
{
    memset(ground, 0, sizeof *ground);
    ground->scenery = scenery;
    if (open_shader(&ground->land, "ground", land_text, reason) != 0)
        return -1;
    if (open_shader(&ground->shore, "water", shore_text, reason) != 0) {
        glDeleteProgram(ground->land.program);
        return -1;
    }
    if (open_tiles(ground) == 0)
        return 0;
    gl_ground_close(ground);
    return reason_set(reason, "no memory for the ground");
}

void gl_ground_close(struct gl_ground *ground)
{
    for (uint32_t i = 0; i < GL_TILES; i++) {
        glDeleteVertexArrays(1, &ground->tiles[i].array);
        glDeleteBuffers(1, &ground->tiles[i].vertices);
        glDeleteTextures(1, &ground->tiles[i].texture);
    }
    glDeleteBuffers(1, &ground->triangles);
    glDeleteProgram(ground->land.program);
    glDeleteProgram(ground->shore.program);
    free(ground->rgba);
    free(ground->light);
}

/* Has a crater come into the patch since its tile was made? */
static bool dug_since(const struct gl_tile *tile, const struct crater_index *craters)
{
    double side = ground_patch_side(tile->patch.level);
    double x0 = tile->patch.column * side, z0 = tile->patch.row * side;
    for (uint32_t i = tile->craters; i < craters->count; i++) {
        const struct crater *crater = &craters->craters[i];
        double reach = 3.0 * (double)crater->radius_m;
        if (crater->x + reach > x0 && crater->x - reach < x0 + side && crater->z + reach > z0 &&
            crater->z - reach < z0 + side)
            return true;
    }
    return false;
}

static bool has_water(const uint8_t *rgba)
{
    for (size_t i = 0; i < (size_t)GL_TILE_TEXELS * GL_TILE_TEXELS; i++)
        if (rgba[i * 4 + 3] < PAINT_GROUND_ALPHA - 8)
            return true;
    return false;
}

static void fill(struct gl_ground *ground, struct gl_tile *tile, const struct ground_patch *patch,
                 const struct moment *moment)
{
    static float vertices[GROUND_VERTICES(GROUND_CELLS_MAX)][3];
    double side = ground_patch_side(patch->level);
    struct paint_tile painting = {
        .x = patch->column * side,
        .z = patch->row * side,
        .step_m = side / (GL_TILE_TEXELS - 1),
        .columns = GL_TILE_TEXELS,
        .rows = GL_TILE_TEXELS,
        .sun = light_sun(),
        .relief = 1.0,
        .rgba = ground->rgba,
        .light = ground->light,
    };
    tile->patch = *patch;
    tile->craters = moment->craters->count;
    tile->cells = ground_cells(&moment->world->terrain, moment->craters, patch);
    ground_vertices(&moment->world->terrain, moment->craters, patch, tile->cells, vertices);
    glBindBuffer(GL_ARRAY_BUFFER, tile->vertices);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(GROUND_VERTICES(tile->cells) * sizeof vertices[0]),
                 vertices, GL_STATIC_DRAW);
    paint_ground(moment->world, moment->craters, &painting);
    tile->wet = has_water(ground->rgba);
    glBindTexture(GL_TEXTURE_2D, tile->texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, (GLsizei)GL_TILE_TEXELS, (GLsizei)GL_TILE_TEXELS, 0,
                 GL_RGBA, GL_UNSIGNED_BYTE, ground->rgba);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glGenerateMipmap(GL_TEXTURE_2D);
}

/* The patch's tile, made or made again if need be. */
static struct gl_tile *tile_of(struct gl_ground *ground, const struct ground_patch *patch,
                               const struct moment *moment)
{
    struct gl_tile *oldest = &ground->tiles[0], *found = NULL;
    for (uint32_t i = 0; i < GL_TILES && found == NULL; i++) {
        struct gl_tile *tile = &ground->tiles[i];
        if (tile->used != 0 && tile->patch.level == patch->level &&
            tile->patch.column == patch->column && tile->patch.row == patch->row)
            found = tile;
        else if (tile->used < oldest->used)
            oldest = tile;
    }
    if (found == NULL) {
        found = oldest;
        fill(ground, found, patch, moment);
    } else if (found->craters != moment->craters->count) {
        if (found->craters > moment->craters->count || dug_since(found, moment->craters))
            fill(ground, found, patch, moment);
        found->craters = moment->craters->count;
    }
    found->used = ground->pictures;
    return found;
}

static float fraction(double v)
{
    return (float)(v - floor(v));
}

static void draw_tile(const struct gl_ground *ground, const struct gl_ground_shader *shader,
                      const struct scene *scene, const struct gl_tile *tile)
{
    double side = ground_patch_side(tile->patch.level);
    double x = tile->patch.column * side, z = tile->patch.row * side;
    float corner[3];
    scene_place(scene, (struct vec3){x, 0.0, z}, corner);
    glUniform4f(shader->u_origin, corner[0], corner[1], corner[2], (float)side);
    glUniform4f(shader->u_detail, fraction(x / DETAIL_M), fraction(z / DETAIL_M),
                fraction((x + 0.35 * z) / BROAD_M), fraction((z - 0.35 * x) / BROAD_M));
    glBindTexture(GL_TEXTURE_2D, tile->texture);
    glBindVertexArray(tile->array);
    glDrawElements(GL_TRIANGLES, (GLsizei)(3 * GROUND_TRIANGLES(tile->cells)), GL_UNSIGNED_SHORT,
                   (const void *)ground->first[tile->cells]);
}

void gl_ground_draw(struct gl_ground *ground, const struct scene *scene,
                    const struct moment *moment)
{
    ground->pictures++;
    glEnable(GL_CULL_FACE);
    glActiveTexture(GL_TEXTURE0 + UNIT_TILE);
    for (uint32_t i = 0; i < scene->patch_count; i++) {
        const struct gl_tile *tile = tile_of(ground, &scene->patches[i], moment);
        const struct gl_ground_shader *shader = tile->wet ? &ground->shore : &ground->land;
        glUseProgram(shader->program);
        draw_tile(ground, shader, scene, tile);
    }
    glDisable(GL_CULL_FACE);
}
