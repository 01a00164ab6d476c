/* Compiling shaders, and the text that all of them share. */
#include "renderer/gl/gl_internal.h"

#include "renderer/scene/frame/light.h"
#include "renderer/scene/terrain/terrain_tiles.h"

#include <stdio.h>
#include <string.h>

#define LOG_BYTES 512

/* Constants of light.h and terrain_tiles.h, under the same names. */
#define NUMBER(name) "const float " #name " = " LIGHT_TEXT(name) ";\n"
#define COLOUR(name) "const vec3 " #name " = vec3(" LIGHT_TEXT(name) ");\n"

/* clang-format off */
static const char numbers_text[] =
    "#version 330 core\n"
    COLOUR(SKY_DEEP) COLOUR(SKY_MID) COLOUR(HORIZON_COOL) COLOUR(HORIZON_WARM) COLOUR(FOG_WHITE)
    COLOUR(SUN_WARM) COLOUR(CLOUD_SHADE) COLOUR(CLOUD_LIT) COLOUR(FOAM_WHITE)
    NUMBER(SUN_EDGE) NUMBER(SUN_WHOLE)
    NUMBER(FINE_M) NUMBER(FINE_FADES_M) NUMBER(FINE_FADED_M)
    NUMBER(WAVES_M) NUMBER(WAVE_STEEP) NUMBER(WAVE_HALF_M) NUMBER(WAVE_LIFT) NUMBER(SURF_S)
    NUMBER(SHORE_WATER) NUMBER(SHORE_GROUND) NUMBER(TILE_WANTED) NUMBER(TILE_COVERED)
    NUMBER(SKY_LIGHT_RED) NUMBER(SKY_LIGHT_GREEN) NUMBER(SKY_LIGHT_BLUE)
    NUMBER(SUN_LIGHT_RED) NUMBER(SUN_LIGHT_GREEN) NUMBER(SUN_LIGHT_BLUE);
/* clang-format on */

/* One model of light and air for all shaders, so that distant ground fades into the colour that the
 * sky has there. */
static const char shared_text[] =
    "layout(std140) uniform frame {\n"
    "    mat4 u_matrix;\n"
    "    vec4 u_right, u_up, u_forward, u_sun, u_fog;\n"
    "};\n"
    "const vec3 sky_light = vec3(SKY_LIGHT_RED, SKY_LIGHT_GREEN, SKY_LIGHT_BLUE);\n"
    "const vec3 sun_light = vec3(SUN_LIGHT_RED, SUN_LIGHT_GREEN, SUN_LIGHT_BLUE);\n"
    "vec3 horizon(vec3 way)\n"
    "{\n"
    "    float towards = dot(normalize(way.xz + vec2(1e-5, 0.0)), normalize(u_sun.xz));\n"
    "    float glow = 0.5 + 0.5 * towards;\n"
    "    return mix(HORIZON_COOL, HORIZON_WARM, glow * glow * glow);\n"
    "}\n"
    /* The fog's colour is half the horizon's. */
    "vec3 white(vec3 way)\n"
    "{\n"
    "    return mix(FOG_WHITE, horizon(way), 0.5);\n"
    "}\n"
    "vec3 sky(vec3 way)\n"
    "{\n"
    "    float high = max(way.y, 0.0);\n"
    "    vec3 c = mix(SKY_MID, SKY_DEEP, 1.0 - exp(-2.6 * high));\n"
    "    return mix(c, horizon(way), exp(-9.0 * high));\n"
    "}\n"
    /* The opacity of the fog between the eye and the sky in a unit direction: all the fog above the
     * eye, along the slanted path. */
    "float sky_fog(vec3 way)\n"
    "{\n"
    "    float fog = u_fog.y * exp(-u_fog.w * u_fog.z);\n"
    "    return fog / (fog + u_fog.z * max(way.y, 1e-4));\n"
    "}\n"
    /* The air between the eye and a point [m from the eye]: its colour, and its opacity in
     * alpha. */
    "vec4 air(vec3 place)\n"
    "{\n"
    "    float far = length(place);\n"
    "    float rise = place.y * u_fog.z;\n"
    "    float layer = abs(rise) > 1e-3 ? (1.0 - exp(-rise)) / rise : 1.0;\n"
    "    float fog = u_fog.y * exp(-u_fog.w * u_fog.z) * layer * far;\n"
    "    float haze = u_fog.x * far;\n"
    "    vec3 way = place / max(far, 1e-3);\n"
    "    float all = fog + haze;\n"
    "    return vec4(mix(horizon(way), white(way), fog / max(all, 1e-6)), 1.0 - exp(-all));\n"
    "}\n";

static GLuint compile(GLenum type, const char *before, const char *text, char log[LOG_BYTES])
{
    const char *texts[] = {numbers_text, shared_text, before, text};
    GLuint shader = glCreateShader(type);
    glShaderSource(shader, 4, texts, NULL);
    glCompileShader(shader);
    GLint good = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good)
        return shader;
    glGetShaderInfoLog(shader, LOG_BYTES, NULL, log);
    glDeleteShader(shader);
    return 0;
}

static void name_units(GLuint program)
{
    static const struct {
        const char *name;
        enum gl_unit unit;
    } samplers[] = {
        {"u_tile", UNIT_TILE},     {"u_detail", UNIT_DETAIL}, {"u_plant", UNIT_PLANT},
        {"u_facing", UNIT_FACING}, {"u_puff", UNIT_PARTICLE}, {"u_cloud", UNIT_CLOUD},
        {"u_dents", UNIT_DENTS},
    };
    glUseProgram(program);
    for (size_t i = 0; i < sizeof samplers / sizeof samplers[0]; i++)
        glUniform1i(glGetUniformLocation(program, samplers[i].name), (GLint)samplers[i].unit);
    GLuint block = glGetUniformBlockIndex(program, "frame");
    if (block != GL_INVALID_INDEX)
        glUniformBlockBinding(program, block, 0);
}

GLuint gl_program(const char *name, const char *vertex, const char *fragment,
                  struct error_text *error)
{
    return gl_program_on(name, "", vertex, fragment, error);
}

GLuint gl_program_on(const char *name, const char *before, const char *vertex, const char *fragment,
                     struct error_text *error)
{
    char log[LOG_BYTES] = "";
    GLuint program = 0, vs = compile(GL_VERTEX_SHADER, before, vertex, log), fs = 0;
    if (vs != 0)
        fs = compile(GL_FRAGMENT_SHADER, "", fragment, log);
    if (fs != 0) {
        GLint good = GL_FALSE;
        program = glCreateProgram();
        glAttachShader(program, vs);
        glAttachShader(program, fs);
        glLinkProgram(program);
        glGetProgramiv(program, GL_LINK_STATUS, &good);
        if (!good) {
            glGetProgramInfoLog(program, LOG_BYTES, NULL, log);
            glDeleteProgram(program);
            program = 0;
        }
    }
    glDeleteShader(vs);
    glDeleteShader(fs);
    if (program == 0)
        error_text_set(error, "the OpenGL driver refuses the %s shader: %.200s", name, log);
    else
        name_units(program);
    return program;
}

void gl_attribute(GLuint index, GLint floats, size_t stride, size_t offset, GLuint divisor)
{
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, floats, GL_FLOAT, GL_FALSE, (GLsizei)stride,
                          (const void *)(uintptr_t)offset);
    glVertexAttribDivisor(index, divisor);
}
