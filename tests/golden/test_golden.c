/* Golden pictures: what the software back end draws is, to the bit, the picture that is kept here,
 * on one thread and on three; and OpenGL draws the same within a measure, where there is OpenGL.
 * They are looked at by people before they are kept. GOLDEN=write keeps new ones; a picture that
 * differs is left beside the test's program to be looked at. */
#include "tests/bench/scene.h"
#include "renderer/image/png.h"
#include "renderer/gl/gl.h"
#include "renderer/gl/gl_devices.h"
#include "renderer/soft/soft.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <fcntl.h>
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define WIDTH  320u
#define HEIGHT 180u
#define BYTES  ((size_t)WIDTH * HEIGHT * 4)

/* The back ends filter textures and round differently: a grain of noise everywhere, no more. */
#define PSNR_LEAST_DB 32.0
#define BLOCK         20u  /* [pixel] what eyes see as one spot ... */
#define BLOCK_MOST    10.0 /* ... differs in its mean colour by no more than this of 255 */

struct golden {
    const char *name, *scenario;
    uint64_t frame;
    uint32_t follow;
    enum view_mode view;
    struct view_camera_pose pose;
};

static const struct golden goldens[] = {
    {.name = "battle", .frame = 1200, .view = VIEW_CHASE, .follow = 1},
    {.name = "inside", .frame = 900, .view = VIEW_INSIDE},
    {.name = "overhead", .frame = 900, .view = VIEW_OVERHEAD},
    {.name = "coast",
     .frame = 60,
     .view = VIEW_FREE,
     .pose = {.given = true,
              .x = 6300.0,
              .z = 28500.0,
              .above_m = 80.0,
              .heading_rad = 5.8,
              .pitch_rad = -0.1}},
    {.name = "brush",
     .frame = 60,
     .view = VIEW_FREE,
     .pose = {.given = true,
              .x = 9000.0,
              .z = 12000.0,
              .above_m = 14.0,
              .heading_rad = 5.2,
              .pitch_rad = -0.05}},
    {.name = "course",
     .scenario = "training",
     .frame = 30,
     .view = VIEW_FREE,
     .pose = {.given = true,
              .x = 24985.0,
              .z = 24800.0,
              .above_m = 6.0,
              .heading_rad = 0.44,
              .pitch_rad = -0.2}},
    {.name = "ford",
     .scenario = "training",
     .frame = 30,
     .view = VIEW_FREE,
     .pose = {.given = true,
              .x = 25080.0,
              .z = 24985.0,
              .above_m = 12.0,
              .heading_rad = 0.15,
              .pitch_rad = -0.2}},
    {.name = "effects", .scenario = "effects", .frame = 345, .view = VIEW_CHASE, .follow = 10},
    {.name = "broadside", .scenario = "figure-a3-broadside", .frame = 200, .view = VIEW_ORBIT},
    {.name = "stump", .scenario = "figure-a6-tree-fast", .frame = 200, .view = VIEW_CHASE},
    {.name = "tower", .scenario = "figure-a9-tower-fast", .frame = 210, .view = VIEW_CHASE},
};

#define GOLDENS (sizeof goldens / sizeof goldens[0])

static char kept_folder[512], drawn_folder[512];

/* The pictures of one scene: ours on one thread and on three, and OpenGL's. */
static uint8_t *one, *three, *opengl;
static bool has_opengl;

static void draw_with(struct bench_scene *scene, const struct frame_view *frame_view,
                      struct back_end_interface *other, uint8_t *pixels)
{
    struct back_end_interface own = scene->draw;
    scene->draw = *other;
    bench_scene_draw(scene, frame_view);
    memcpy(pixels, scene->image.pixels, BYTES);
    other->close(other->self);
    scene->draw = own;
}

static int draw_all(void **state)
{
    static struct bench_scene scene;
    const struct golden *golden = *state;
    const struct bench_scene_options scene_options = {.scenario = golden->scenario,
                                                      .frame = golden->frame,
                                                      .width = WIDTH,
                                                      .height = HEIGHT,
                                                      .threads = 1,
                                                      .soft = true,
                                                      .follow = golden->follow,
                                                      .view = golden->view,
                                                      .pose = golden->pose};
    const struct gl_request any = {.device = NULL};
    char name[BACK_END_NAME_BYTES];
    struct error_text error;
    struct back_end_interface other;
    bench_scene_open(&scene, &scene_options);
    struct frame_view frame_view = bench_scene_frame_view(&scene);
    bench_scene_build(&scene, &frame_view);
    bench_scene_draw(&scene, &frame_view);
    memcpy(one, scene.image.pixels, BYTES);
    assert_int_equal(soft_open(&other, &scene.static_scene, WIDTH, HEIGHT, 3, &error), 0);
    draw_with(&scene, &frame_view, &other, three);
    has_opengl = gl_open(&other, &scene.static_scene, WIDTH, HEIGHT, &any, name, &error) == 0;
    if (has_opengl)
        draw_with(&scene, &frame_view, &other, opengl);
    else
        print_message("# no OpenGL: %s\n", error.text);
    bench_scene_close(&scene);
    return 0;
}

static void keep(const char *folder, const char *name, uint8_t *pixels)
{
    char path[1024];
    const struct image image = {.width = WIDTH, .height = HEIGHT, .pixels = pixels};
    snprintf(path, sizeof path, "%s/%s.png", folder, name);
    assert_int_equal(png_write_file(AT_FDCWD, path, &image, "jolon golden picture"), 0);
}

static void read_kept(const char *name, uint8_t *pixels)
{
    char path[1024];
    png_image png = {.version = PNG_IMAGE_VERSION};
    snprintf(path, sizeof path, "%s/%s.png", kept_folder, name);
    if (!png_image_begin_read_from_file(&png, path))
        fail_msg("%s: %s; GOLDEN=write makes it", path, png.message);
    png.format = PNG_FORMAT_RGBA;
    assert_int_equal(png.width, WIDTH);
    assert_int_equal(png.height, HEIGHT);
    assert_true(png_image_finish_read(&png, NULL, pixels, 0, NULL) != 0);
}

static uint32_t different(const uint8_t *a, const uint8_t *b)
{
    uint32_t count = 0;
    for (size_t i = 0; i < BYTES; i += 4)
        count += memcmp(a + i, b + i, 3) != 0;
    return count;
}

static double psnr_db(const uint8_t *a, const uint8_t *b)
{
    double sum = 0.0;
    for (size_t i = 0; i < BYTES; i++)
        if (i % 4 != 3)
            sum += ((double)a[i] - b[i]) * ((double)a[i] - b[i]);
    return 10.0 * log10(255.0 * 255.0 * 0.75 * BYTES / fmax(sum, 1e-9));
}

/* The most that the mean colour of a block differs, 0..255. */
static double worst_block(const uint8_t *a, const uint8_t *b)
{
    double worst = 0.0;
    for (uint32_t top = 0; top < HEIGHT; top += BLOCK)
        for (uint32_t left = 0; left < WIDTH; left += BLOCK)
            for (uint32_t c = 0; c < 3; c++) {
                double sum = 0.0;
                for (uint32_t i = 0; i < BLOCK * BLOCK; i++) {
                    size_t at = ((size_t)(top + i / BLOCK) * WIDTH + left + i % BLOCK) * 4 + c;
                    sum += (double)a[at] - b[at];
                }
                worst = fmax(worst, fabs(sum) / (BLOCK * BLOCK));
            }
    return worst;
}

static void test_exact(void **state)
{
    const struct golden *golden = *state;
    uint8_t *kept = malloc(BYTES);
    assert_non_null(kept);
    if (different(one, three) != 0)
        fail_msg("%s: %u pixels differ on three threads", golden->name, different(one, three));
    const char *mode = getenv("GOLDEN");
    if (mode != NULL && strcmp(mode, "write") == 0)
        keep(kept_folder, golden->name, one);
    read_kept(golden->name, kept);
    if (different(one, kept) != 0) {
        keep(drawn_folder, golden->name, one);
        fail_msg("%s: %u pixels are not those of %s/%s.png; look at %s/%s.png", golden->name,
                 different(one, kept), kept_folder, golden->name, drawn_folder, golden->name);
    }
    free(kept);
}

static void test_opengl(void **state)
{
    const struct golden *golden = *state;
    if (!has_opengl)
        skip();
    double psnr = psnr_db(opengl, one), block = worst_block(opengl, one);
    print_message("# %s: %.1f dB, worst spot %.1f\n", golden->name, psnr, block);
    if (psnr < PSNR_LEAST_DB || block > BLOCK_MOST) {
        keep(drawn_folder, golden->name, opengl);
        fail_msg("%s: OpenGL's picture is %.1f dB from ours (at least %.0f), its worst "
                 "spot %.1f off (at most %.0f); look at %s/%s.png",
                 golden->name, psnr, PSNR_LEAST_DB, block, BLOCK_MOST, drawn_folder, golden->name);
    }
}

int main(void)
{
    static struct CMUnitTest tests[2 * GOLDENS];
    static char names[2 * GOLDENS][64];
    ssize_t length = readlink("/proc/self/exe", drawn_folder, sizeof drawn_folder - 1);
    if (length <= 0)
        return 1;
    *strrchr(drawn_folder, '/') = '\0';
    one = malloc(BYTES);
    three = malloc(BYTES);
    opengl = malloc(BYTES);
    if (one == NULL || three == NULL || opengl == NULL)
        return 1;
    const char *given = getenv("JOLON_GOLDENS");
    snprintf(kept_folder, sizeof kept_folder, "%s", given != NULL ? given : "tests/golden");
    for (size_t i = 0; i < GOLDENS; i++) {
        snprintf(names[2 * i], sizeof names[0], "%s, exactly", goldens[i].name);
        snprintf(names[2 * i + 1], sizeof names[0], "%s, by OpenGL", goldens[i].name);
        void *state = (void *)(uintptr_t)&goldens[i];
        tests[2 * i] = (struct CMUnitTest){names[2 * i], test_exact, draw_all, NULL, state};
        tests[2 * i + 1] = (struct CMUnitTest){names[2 * i + 1], test_opengl, NULL, NULL, state};
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
