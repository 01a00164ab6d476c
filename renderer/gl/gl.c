/* The OpenGL back end: drawing one picture and reading it back. */
#include "renderer/gl/gl.h"

#include "renderer/gl/gl_context.h"
#include "renderer/gl/gl_internal.h"
#include "renderer/scene/frame/light.h"
#include "renderer/soft/fxaa.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct gl {
    struct gl_context context;
    struct gl_textures textures;
    struct gl_ground ground;
    struct gl_bodies bodies;
    struct gl_billboards billboards;
    GLuint sky_program, empty_array, frame_block;
    GLuint target, colour, depth; /* what the scene is drawn into */
    uint32_t width, height;       /* of the largest picture */
    struct image drawn;           /* read back, before FXAA; it has the size of the last picture */
    uint8_t *row;                 /* scratch */
};

static const char sky_vertex_text[] =
    "out vec3 v_way;\n"
    "void main()\n"
    "{\n"
    "    vec2 corner = vec2(float(gl_VertexID & 1) * 4.0 - 1.0,\n"
    "                       float(gl_VertexID >> 1) * 4.0 - 1.0);\n"
    "    v_way = u_forward.xyz + u_right.xyz * (corner.x * u_right.w)\n"
    "          + u_up.xyz * (corner.y * u_up.w);\n"
    "    gl_Position = vec4(corner, 1.0, 1.0);\n"
    "}\n";

static const char sky_fragment_text[] =
    "uniform sampler2D u_cloud;\n"
    "in vec3 v_way;\n"
    "out vec4 o_colour;\n"
    "void main()\n"
    "{\n"
    "    vec3 way = normalize(v_way);\n"
    "    vec3 colour = sky(way);\n"
    "    float sun = max(dot(way, u_sun.xyz), 0.0);\n"
    "    float s8 = sun * sun * sun * sun;\n"
    "    s8 *= s8;\n"
    "    float s32 = s8 * s8;\n"
    "    s32 *= s32;\n"
    "    float s256 = s32 * s32;\n"
    "    s256 *= s256;\n"
    "    s256 *= s256;\n"
    "    float disc = clamp((sun - SUN_EDGE) / (SUN_WHOLE - SUN_EDGE), 0.0, 1.0);\n"
    "    vec3 glow = SUN_WARM * (0.20 * s32 + 0.30 * s256 + disc);\n"
    "    colour += glow;\n"
    "    if (way.y > 0.01) {\n"
    "        vec2 at = way.xz / (way.y + 0.12);\n"
    "        float broad = texture(u_cloud, at * 0.11 + 0.0004 * u_forward.w).r;\n"
    "        float fine = texture(u_cloud, at * 0.47 + 0.0007 * u_forward.w).r;\n"
    "        float cloud = smoothstep(0.50, 0.78, 0.68 * broad + 0.36 * fine);\n"
    "        cloud *= 0.72 * smoothstep(0.02, 0.16, way.y);\n"
    "        vec3 lit = mix(CLOUD_SHADE, CLOUD_LIT, 0.4 + 0.6 * fine);\n"
    "        colour = mix(colour, lit + 0.5 * glow, cloud);\n"
    "    }\n"
    "    colour = mix(colour, white(way), sky_fog(way));\n"
    "    o_colour = vec4(colour, 1.0);\n"
    "}\n";

static int open_target(struct gl *gl, struct error_text *error)
{
    GLsizei width = (GLsizei)gl->width, height = (GLsizei)gl->height;
    glGenFramebuffers(1, &gl->target);
    glBindFramebuffer(GL_FRAMEBUFFER, gl->target);
    glGenRenderbuffers(1, &gl->colour);
    glBindRenderbuffer(GL_RENDERBUFFER, gl->colour);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, gl->colour);
    glGenRenderbuffers(1, &gl->depth);
    glBindRenderbuffer(GL_RENDERBUFFER, gl->depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                              gl->depth);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE)
        return 0;
    return error_text_set(error, "the OpenGL driver cannot draw into a %ux%u picture", gl->width,
                          gl->height);
}

static void send_frame(const struct gl *gl, const struct draw_list *list)
{
    const struct camera *c = &list->camera;
    struct gl_frame frame = {
        .right = {(float)c->right.x, (float)c->right.y, (float)c->right.z, (float)c->tan_x},
        .up = {(float)c->up.x, (float)c->up.y, (float)c->up.z, (float)c->tan_y},
        .forward = {(float)c->forward.x, (float)c->forward.y, (float)c->forward.z,
                    (float)fmod(list->time_s, 3600.0)},
        .sun = {(float)SUN_X, (float)SUN_Y, (float)SUN_Z, list->texture ? 1.0f : 0.0f},
        .fog = {(float)(list->haze ? HAZE_PER_M : CLEAR_PER_M), list->fog ? (float)FOG_PER_M : 0.0f,
                (float)FOG_FALL_PER_M, (float)(c->eye.y - FOG_BASE_M)},
    };
    memcpy(frame.matrix, c->matrix, sizeof frame.matrix);
    glBindBuffer(GL_UNIFORM_BUFFER, gl->frame_block);
    glBufferData(GL_UNIFORM_BUFFER, sizeof frame, &frame, GL_STREAM_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, gl->frame_block);
}

/* The stencil makes shadows darken a pixel only once, however many fall on it. */
static void draw_shadows(struct gl *gl, const struct draw_list *list)
{
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_EQUAL, 0, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-2.0f, -4.0f);
    gl_bodies_draw_shadows(&gl->bodies, list);
    gl_plants_draw_shadows(&gl->billboards, list);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    glDisable(GL_STENCIL_TEST);
}

static void draw_scene(struct gl *gl, const struct draw_list *list,
                       const struct frame_view *frame_view)
{
    glBindFramebuffer(GL_FRAMEBUFFER, gl->target);
    glViewport(0, 0, (GLsizei)gl->drawn.width, (GLsizei)gl->drawn.height);
    glClearStencil(0);
    glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    gl_ground_draw(&gl->ground, list, frame_view);
    draw_shadows(gl, list);
    gl_bodies_draw(&gl->bodies, list);
    gl_plants_draw(&gl->billboards, list);
    glUseProgram(gl->sky_program);
    glBindVertexArray(gl->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    gl_particles_draw(&gl->billboards, list);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
}

/* Reads the picture back and flips it, since OpenGL's rows begin at the bottom. */
static void read_back(struct gl *gl)
{
    GLsizei width = (GLsizei)gl->drawn.width, height = (GLsizei)gl->drawn.height;
    size_t row_bytes = (size_t)gl->drawn.width * 4;
    uint8_t *top = gl->drawn.pixels, *low = top + (gl->drawn.height - 1) * row_bytes;
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, gl->drawn.pixels);
    for (; top < low; top += row_bytes, low -= row_bytes) {
        memcpy(gl->row, top, row_bytes);
        memcpy(top, low, row_bytes);
        memcpy(low, gl->row, row_bytes);
    }
}

static int gl_picture(void *self, const struct draw_list *list, const struct frame_view *frame_view,
                      struct image *image, struct error_text *error)
{
    struct gl *gl = self;
    gl->drawn.width = image->width;
    gl->drawn.height = image->height;
    send_frame(gl, list);
    gl_bodies_send(&gl->bodies, list);
    gl_billboards_send(&gl->billboards, list);
    draw_scene(gl, list, frame_view);

    read_back(gl);
    fxaa_edges(image, &gl->drawn);
    GLenum code = glGetError();
    if (code == GL_NO_ERROR)
        return 0;
    return error_text_set(error, "OpenGL failed while drawing (%s)",
                          code == GL_OUT_OF_MEMORY ? "out of memory" : "driver error");
}

static void free_memory(struct gl *gl)
{
    image_free(&gl->drawn);
    free(gl->row);
    free(gl);
}

static void gl_close(void *self)
{
    struct gl *gl = self;
    gl_billboards_close(&gl->billboards);
    gl_bodies_close(&gl->bodies);
    gl_ground_close(&gl->ground);
    gl_textures_close(&gl->textures);
    gl_context_close(&gl->context);
    free_memory(gl);
}

static int open_programs(struct gl *gl, struct error_text *error)
{
    gl->sky_program = gl_program("sky", sky_vertex_text, sky_fragment_text, error);
    if (gl->sky_program == 0)
        return -1;
    glGenVertexArrays(1, &gl->empty_array);
    glGenBuffers(1, &gl->frame_block);
    return 0;
}

int gl_open(struct back_end_interface *draw, const struct static_scene *static_scene,
            uint32_t width, uint32_t height, const struct gl_request *request,
            char name[BACK_END_NAME_BYTES], struct error_text *error)
{
    struct gl *gl = calloc(1, sizeof *gl);
    if (gl == NULL)
        return error_text_set(error, "no memory for OpenGL");
    gl->width = width;
    gl->height = height;
    gl->row = malloc((size_t)width * 4);
    if (gl->row == NULL || image_init(&gl->drawn, width, height) != 0) {
        error_text_set(error, "no memory for a %ux%u picture", width, height);
        goto err_memory;
    }
    if (gl_context_open(&gl->context, request, error) != 0)
        goto err_memory;
    if (open_target(gl, error) != 0 || open_programs(gl, error) != 0)
        goto err_context;
    if (gl_textures_open(&gl->textures, error) != 0)
        goto err_context;
    if (gl_ground_open(&gl->ground, static_scene, error) != 0)
        goto err_textures;
    if (gl_bodies_open(&gl->bodies, static_scene, error) != 0)
        goto err_ground;
    if (gl_billboards_open(&gl->billboards, error) != 0)
        goto err_bodies;
    snprintf(name, BACK_END_NAME_BYTES, "%s", gl->context.name);
    *draw = (struct back_end_interface){.self = gl, .picture = gl_picture, .close = gl_close};
    return 0;

err_bodies:
    gl_bodies_close(&gl->bodies);
err_ground:
    gl_ground_close(&gl->ground);
err_textures:
    gl_textures_close(&gl->textures);
err_context:
    gl_context_close(&gl->context);
err_memory:
    free_memory(gl);
    return -1;
}
