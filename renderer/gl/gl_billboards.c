/* Plants and particles in OpenGL: pictures that face the eye, each kind in one draw. */
#include "renderer/gl/gl_internal.h"

#include <stddef.h>

static const char plant_vertex_text[] =
    "layout(location = 0) in vec3 i_at;\n"
    "layout(location = 1) in vec4 i_form;\n" /* width, height, lean, picture */
    "layout(location = 3) in vec3 i_tint;\n"
    "out vec3 v_picture, v_tint, v_right, v_out;\n"
    "out vec4 v_air;\n"
    "out float v_cut;\n"
    "void main()\n"
    "{\n"
    "    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));\n"
    "    vec2 ahead = normalize(i_at.xz + vec2(1e-5, 0.0));\n"
    "    v_right = vec3(-ahead.y, 0.0, ahead.x);\n"
    "    v_out = vec3(-ahead.x, 0.0, -ahead.y);\n"
    "    float aside = (corner.x - 0.5) * i_form.x + i_form.z * corner.y * i_form.y;\n"
    "    float level = length(i_at.xz), steep = 0.70710678 / length(i_at);\n"
    "    float back = max((-i_at.y - level) * steep, 0.0);\n"
    "    float rise = back > 0.0 ? (level - i_at.y) * steep : 1.0;\n"
    "    vec3 top = vec3(ahead.x * back, rise, ahead.y * back);\n"
    "    vec3 place = i_at + v_right * aside + top * (corner.y * i_form.y);\n"
    "    gl_Position = u_matrix * vec4(place, 1.0);\n"
    "    v_picture = vec3(corner.x, 1.0 - corner.y, i_form.w);\n"
    "    v_tint = i_tint;\n"
    "    v_air = air(place);\n"
    /* Texels of small pictures are averages of leaves and gaps: a lower threshold keeps the plant's
     * size. */
    "    v_cut = mix(0.5, 0.22, smoothstep(150.0, 1800.0, length(i_at)));\n"
    "}\n";

static const char plant_fragment_text[] =
    "uniform sampler2DArray u_plant, u_facing;\n"
    "in vec3 v_picture, v_tint, v_right, v_out;\n"
    "in vec4 v_air;\n"
    "in float v_cut;\n"
    "out vec4 o_colour;\n"
    "void main()\n"
    "{\n"
    "    vec4 leaf = texture(u_plant, v_picture);\n"
    "    if (leaf.a < v_cut)\n"
    "        discard;\n"
    "    vec3 f = texture(u_facing, v_picture).xyz * 2.0 - 1.0;\n"
    "    vec3 n = normalize(v_right * f.x + vec3(0.0, f.y, 0.0) + v_out * f.z);\n"
    "    float sun = dot(n, u_sun.xyz);\n"
    "    float through = 0.16 * max(-sun, 0.0);\n"
    "    float open = mix(0.62, 1.05, smoothstep(1.0, 0.35, v_picture.y));\n"
    "    vec3 light = sky_light * (0.80 + 0.35 * n.y) * open\n"
    "               + sun_light * (max(0.85 * sun + 0.15, 0.0) + through) * open;\n"
    "    vec3 colour = u_sun.w > 0.5 ? leaf.rgb * v_tint : vec3(0.25, 0.32, 0.15);\n"
    "    o_colour = vec4(mix(colour * light, v_air.rgb, v_air.a), 1.0);\n"
    "}\n";

/* A plant's shadow: its picture laid on the ground, away from the sun. */
static const char shadow_vertex_text[] =
    "layout(location = 0) in vec3 i_at;\n"
    "layout(location = 1) in vec4 i_form;\n"
    "layout(location = 2) in vec2 i_slope;\n"
    "out vec3 v_picture;\n"
    "out float v_clear;\n"
    "void main()\n"
    "{\n"
    "    v_picture = vec3(0.0);\n"
    "    v_clear = 0.0;\n"
    "    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);\n"
    "    float far = length(i_at);\n"
    "    if (far > 2200.0 || i_form.y < 0.3 || (i_form.y < 1.3 && far > 60.0))\n"
    "        return;\n"
    "    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));\n"
    "    vec2 away = -normalize(u_sun.xz);\n"
    "    vec2 across = vec2(-away.y, away.x);\n"
    /* The shadow ends where the sun's ray through the top meets the slope. */
    "    float steep = u_sun.y / length(u_sun.xz) + dot(i_slope, away);\n"
    "    float reach = i_form.y / max(steep, 0.25);\n"
    "    float aside = (corner.x - 0.5) * i_form.x + i_form.z * corner.y * i_form.y;\n"
    "    vec2 off = across * aside + away * corner.y * reach;\n"
    "    vec3 place = i_at + vec3(off.x, dot(i_slope, off) + 0.10 + 0.02 * i_form.y, off.y);\n"
    "    gl_Position = u_matrix * vec4(place, 1.0);\n"
    "    v_picture = vec3(corner.x, 1.0 - corner.y, i_form.w);\n"
    "    v_clear = (1.0 - air(place).a) * smoothstep(2200.0, 1400.0, far);\n"
    "}\n";

static const char shadow_fragment_text[] =
    "uniform sampler2DArray u_plant;\n"
    "in vec3 v_picture;\n"
    "in float v_clear;\n"
    "out vec4 o_colour;\n"
    "void main()\n"
    "{\n"
    "    if (texture(u_plant, v_picture).a < 0.4)\n"
    "        discard;\n"
    "    o_colour = vec4(0.05, 0.06, 0.09, 0.50 * v_clear);\n"
    "}\n";

static const char particle_vertex_text[] =
    "layout(location = 0) in vec3 i_at;\n"
    "layout(location = 1) in vec3 i_axis;\n"
    "layout(location = 2) in vec4 i_form;\n" /* size, turn, picture, glow */
    "layout(location = 3) in vec4 i_colour;\n"
    "out vec3 v_picture;\n"
    "out vec4 v_colour, v_air;\n"
    "out float v_glow;\n"
    "void main()\n"
    "{\n"
    "    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;\n"
    "    vec3 off;\n"
    "    if (dot(i_axis, i_axis) > 0.0) {\n"
    "        vec3 side = normalize(cross(i_axis, i_at)) * i_form.x;\n"
    "        off = i_axis * corner.y + side * corner.x;\n"
    "    } else {\n"
    "        float c = cos(i_form.y), s = sin(i_form.y);\n"
    "        vec2 turned = vec2(c * corner.x - s * corner.y, s * corner.x + c * corner.y);\n"
    "        off = (u_right.xyz * turned.x + u_up.xyz * turned.y) * i_form.x;\n"
    "    }\n"
    "    gl_Position = u_matrix * vec4(i_at + off, 1.0);\n"
    /* A particle is a ball. Its depth is that of its near side, so that the ground does not cut it
     * along a line. */
    "    vec3 near = i_at + off - normalize(i_at) * min(i_form.x, 0.5 * length(i_at));\n"
    "    vec4 clip = u_matrix * vec4(near, 1.0);\n"
    "    if (clip.w > 0.5)\n"
    "        gl_Position.z = clip.z / clip.w * gl_Position.w;\n"
    "    v_picture = vec3(corner.x * 0.5 + 0.5, 0.5 - corner.y * 0.5, i_form.z);\n"
    "    v_colour = i_colour;\n"
    "    v_glow = i_form.w;\n"
    "    v_air = air(i_at);\n"
    "}\n";

static const char particle_fragment_text[] =
    "uniform sampler2DArray u_puff;\n"
    "in vec3 v_picture;\n"
    "in vec4 v_colour, v_air;\n"
    "in float v_glow;\n"
    "out vec4 o_colour;\n"
    "void main()\n"
    "{\n"
    "    vec2 puff = texture(u_puff, v_picture).rg;\n"
    "    float much = puff.r * v_colour.a;\n"
    "    if (much < 0.004)\n"
    "        discard;\n"
    "    vec3 lit = v_colour.rgb * (0.35 + 1.3 * puff.g);\n"
    "    vec3 hot = v_colour.rgb * (0.6 + 0.8 * puff.g) * 1.05 + 0.06 * puff.r * puff.r;\n"
    "    vec3 colour = mix(lit, hot, v_glow);\n"
    "    colour = mix(colour, v_air.rgb * (1.0 - v_glow), v_air.a);\n"
    "    o_colour = vec4(colour * much, much * (1.0 - v_glow));\n"
    "}\n";

/* A vertex attribute of an instance: its number of floats and its offset [byte]. */
struct attribute {
    GLint floats;
    size_t offset;
};

static const struct attribute plant_attributes[] = {
    {3, offsetof(struct draw_list_plant, at)},
    {4, offsetof(struct draw_list_plant, width)},
    {2, offsetof(struct draw_list_plant, slope)},
    {3, offsetof(struct draw_list_plant, tint)},
};

static const struct attribute particle_attributes[] = {
    {3, offsetof(struct draw_list_particle, at)},
    {3, offsetof(struct draw_list_particle, axis)},
    {4, offsetof(struct draw_list_particle, size)},
    {4, offsetof(struct draw_list_particle, colour)},
};

static void open_instances(struct gl_instances *instances, const struct attribute attributes[4],
                           size_t stride)
{
    glGenVertexArrays(1, &instances->array);
    glGenBuffers(1, &instances->buffer);
    glBindVertexArray(instances->array);
    glBindBuffer(GL_ARRAY_BUFFER, instances->buffer);
    for (GLuint i = 0; i < 4; i++)
        gl_attribute(i, attributes[i].floats, stride, attributes[i].offset, 1);
}

static void close_instances(struct gl_instances *instances)
{
    glDeleteVertexArrays(1, &instances->array);
    glDeleteBuffers(1, &instances->buffer);
}

static void send_instances(const struct gl_instances *instances, const void *data, size_t bytes)
{
    glBindBuffer(GL_ARRAY_BUFFER, instances->buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)bytes, data, GL_STREAM_DRAW);
}

static void draw_instances(const struct gl_instances *instances, GLuint program, uint32_t count)
{
    glUseProgram(program);
    glBindVertexArray(instances->array);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, (GLsizei)count);
}

int gl_billboards_open(struct gl_billboards *billboards, struct error_text *error)
{
    *billboards = (struct gl_billboards){.plant_program = 0};
    billboards->plant_program = gl_program("plant", plant_vertex_text, plant_fragment_text, error);
    billboards->shadow_program =
        gl_program("plant shadow", shadow_vertex_text, shadow_fragment_text, error);
    billboards->particle_program =
        gl_program("particle", particle_vertex_text, particle_fragment_text, error);
    if (billboards->plant_program == 0 || billboards->shadow_program == 0 ||
        billboards->particle_program == 0) {
        gl_billboards_close(billboards);
        return -1;
    }
    open_instances(&billboards->plants, plant_attributes, sizeof(struct draw_list_plant));
    open_instances(&billboards->particles, particle_attributes, sizeof(struct draw_list_particle));
    return 0;
}

void gl_billboards_close(struct gl_billboards *billboards)
{
    glDeleteProgram(billboards->plant_program);
    glDeleteProgram(billboards->shadow_program);
    glDeleteProgram(billboards->particle_program);
    close_instances(&billboards->plants);
    close_instances(&billboards->particles);
}

void gl_billboards_send(struct gl_billboards *billboards, const struct draw_list *list)
{
    send_instances(&billboards->plants, list->plants, list->plant_count * sizeof *list->plants);
    send_instances(&billboards->particles, list->particles,
                   list->particle_count * sizeof *list->particles);
}

void gl_plants_draw_shadows(struct gl_billboards *billboards, const struct draw_list *list)
{
    draw_instances(&billboards->plants, billboards->shadow_program, list->plant_count);
}

void gl_plants_draw(struct gl_billboards *billboards, const struct draw_list *list)
{
    draw_instances(&billboards->plants, billboards->plant_program, list->plant_count);
}

void gl_particles_draw(struct gl_billboards *billboards, const struct draw_list *list)
{
    draw_instances(&billboards->particles, billboards->particle_program, list->particle_count);
}
