/* Textures that never change: computed once and sent to the driver. */
#include "renderer/gl/gl_internal.h"

#include "renderer/scene/model/plant_impostors.h"
#include "renderer/scene/draw_list/texture.h"

#include <stdlib.h>

static GLuint create_texture(enum gl_unit unit, GLenum target, GLint wrap)
{
    GLuint texture;
    glGenTextures(1, &texture);
    glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(target, texture);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, wrap);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, wrap);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return texture;
}

static GLuint create_repeating(enum gl_unit unit, GLint internal_format, uint32_t side,
                               GLenum format, const void *texels)
{
    GLuint texture = create_texture(unit, GL_TEXTURE_2D, GL_REPEAT);
    glTexImage2D(GL_TEXTURE_2D, 0, internal_format, (GLsizei)side, (GLsizei)side, 0, format,
                 GL_UNSIGNED_BYTE, texels);
    glGenerateMipmap(GL_TEXTURE_2D);
    return texture;
}

/* Creates an array of empty pictures. */
static GLuint create_array(enum gl_unit unit, GLint internal_format, GLsizei side, GLsizei count,
                           GLenum format)
{
    GLuint texture = create_texture(unit, GL_TEXTURE_2D_ARRAY, GL_CLAMP_TO_EDGE);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, internal_format, side, side, count, 0, format,
                 GL_UNSIGNED_BYTE, NULL);
    return texture;
}

static int open_repeating(struct gl_textures *textures)
{
    size_t texels = (size_t)TEXTURE_DETAIL_SIDE * TEXTURE_DETAIL_SIDE;
    uint8_t(*detail)[2] = malloc(texels * sizeof *detail);
    if (detail == NULL)
        return -1;
    texture_detail(detail);
    textures->detail = create_repeating(UNIT_DETAIL, GL_RG8, TEXTURE_DETAIL_SIDE, GL_RG, detail);
    /* At a low angle the ground would otherwise look too blurred. */
    glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_LOD_BIAS, -0.6f);
    free(detail);

    uint8_t *clouds = malloc((size_t)TEXTURE_CLOUD_SIDE * TEXTURE_CLOUD_SIDE);
    if (clouds == NULL)
        return -1;
    texture_clouds(clouds);
    textures->clouds = create_repeating(UNIT_CLOUD, GL_R8, TEXTURE_CLOUD_SIDE, GL_RED, clouds);
    free(clouds);
    return 0;
}

static int open_plants(struct gl_textures *textures)
{
    struct plant_impostors_picture *picture = malloc(sizeof *picture);
    if (picture == NULL)
        return -1;
    GLsizei side = (GLsizei)PLANT_IMPOSTORS_SIDE;
    textures->plants = create_array(UNIT_PLANT, GL_RGBA8, side, PLANT_IMPOSTORS_COUNT, GL_RGBA);
    textures->facing = create_array(UNIT_FACING, GL_RGBA8, side, PLANT_IMPOSTORS_COUNT, GL_RGBA);
    for (GLint i = 0; i < PLANT_IMPOSTORS_COUNT; i++) {
        plant_impostors_paint(picture, (enum plant_impostors)i);
        glActiveTexture(GL_TEXTURE0 + UNIT_PLANT);
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, i, side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                        picture->colour);
        glActiveTexture(GL_TEXTURE0 + UNIT_FACING);
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, i, side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                        picture->facing);
    }
    free(picture);
    glActiveTexture(GL_TEXTURE0 + UNIT_PLANT);
    glGenerateMipmap(GL_TEXTURE_2D_ARRAY);
    glActiveTexture(GL_TEXTURE0 + UNIT_FACING);
    glGenerateMipmap(GL_TEXTURE_2D_ARRAY);
    return 0;
}

static int open_particles(struct gl_textures *textures)
{
    uint8_t(*particle)[2] =
        malloc((size_t)TEXTURE_PARTICLE_SIDE * TEXTURE_PARTICLE_SIDE * sizeof *particle);
    if (particle == NULL)
        return -1;
    GLsizei side = (GLsizei)TEXTURE_PARTICLE_SIDE;
    textures->particles = create_array(UNIT_PARTICLE, GL_RG8, side, PARTICLE_PICTURE_COUNT, GL_RG);
    for (GLint i = 0; i < PARTICLE_PICTURE_COUNT; i++) {
        texture_particle(particle, (enum particle_picture)i);
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, i, side, side, 1, GL_RG, GL_UNSIGNED_BYTE,
                        particle);
    }
    free(particle);
    glGenerateMipmap(GL_TEXTURE_2D_ARRAY);
    return 0;
}

int gl_textures_open(struct gl_textures *textures, struct error_text *error)
{
    *textures = (struct gl_textures){.detail = 0};
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (open_repeating(textures) == 0 && open_plants(textures) == 0 &&
        open_particles(textures) == 0)
        return 0;
    gl_textures_close(textures);
    return error_text_set(error, "no memory for the textures");
}

void gl_textures_close(struct gl_textures *textures)
{
    const GLuint all[] = {textures->detail, textures->plants, textures->facing, textures->particles,
                          textures->clouds};
    glDeleteTextures((GLsizei)(sizeof all / sizeof all[0]), all);
}
