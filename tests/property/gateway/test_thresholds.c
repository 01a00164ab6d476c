/* What receivers show of the default battle: how far each vehicle is from where the dead reckoning
 * of its last Entity State has it, in every frame, and how many Entity States that costs. The test
 * has its own clock: a frame is a sixtieth of a second. FRAMES=n runs longer. */
#include "gateway/entity_output.h"

#include "gateway/udp/udp_socket.h"
#include "ipc/frame/snapshot.h"
#include "tests/support/fixture.h"
#include "world/params.h"

#include <limits.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

#define HZ       60u
#define FRAME_NS (1000000000u / HZ)
#define SETTLE   (6u * HZ) /* frames in which every vehicle is sent */
#define PASS     3u        /* frames from one pass to the next */

/* Bounds of what is further off than a threshold: the share, and the most. */
#define SHARE_MOST      0.001
#define FAR_MOST_M      1.1
#define TURNED_MOST_RAD (6.0 * RAD_PER_DEG)

/* Entity States, as a share of one for each vehicle in each frame. */
#define SENT_MOST 0.01

static struct fixture f;
static struct snapshot poses;
static struct entity_output entities;
static struct pdu_output output;
static struct type_table types;
static int listener;

/* What receivers have of the vehicles of one domain, in all frames. */
struct errors {
    uint64_t all, far, turned;
    double far_m, turned_rad;
};

static void open_world(void)
{
    static char text[1 << 18];
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/scenarios/hunter-liggett.cfg", fixture_shipped_dir());
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    size_t length = fread(text, 1, sizeof text - 1, in);
    fclose(in);
    text[length] = '\0';
    fixture_open(&f, text);
    assert_int_equal(snapshot_init(&poses, &f.view), 0);
}

static void open_output(void)
{
    char path[PATH_MAX], address[] = "127.0.0.1";
    struct error_text error;
    struct udp_address at;
    socklen_t size = sizeof at;
    const struct world *w = &f.view.world;
    output = (struct pdu_output){.version = 7, .exercise = 1};
    assert_int_equal(udp_address_parse(&at, address, 3000, &error), 0);
    at.v4.sin_port = 0;
    listener = udp_socket_listener(&at, 0, &error); /* what comes there is lost */
    assert_true(listener >= 0);
    assert_int_equal(getsockname(listener, &at.any, &size), 0);
    assert_int_equal(pdu_output_open(&output, address, udp_address_port(&at), 0, 100000, &error),
                     0);
    snprintf(path, sizeof path, "%s/dis/types.txt", fixture_shipped_dir());
    assert_int_equal(type_table_read(&types, path, w->kinds, w->counts.kinds, &error), 0);
    entities = (struct entity_output){.output = &output, .types = &types, .ids = {1991, 1, 16}};
    local_frame_make(&entities.frame, 35.95, -121.25, -33.7, 25000.0, 25000.0);
    assert_int_equal(entity_output_open(&entities, &f.view, &error), 0);
}

static void compare_row(struct errors *errors, const struct entities *e, uint32_t row,
                        uint64_t now_ns)
{
    const struct entity_sent *sent = &entities.sent[row];
    struct mat3 turn =
        rotation_matrix(rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll));
    struct mat3 axes = local_frame_axes(&entities.frame, entities_position(e, row));
    struct mat3 right = local_frame_ecef_turn(&axes, &turn), shown;
    struct vec3 at = local_frame_ecef(&entities.frame, entities_position(e, row)), place;
    double since_s = ((double)now_ns - (double)sent->frame_ns) / 1e9;
    dead_reckoning_at(&sent->state, since_s, &place, &shown);
    double far_m = vec3_length(vec3_sub(place, at)),
           turned_rad = euler_angle_between(&shown, &right);
    errors->all++;
    errors->far += far_m > ENTITY_OUTPUT_POSITION_M;
    errors->turned += turned_rad > ENTITY_OUTPUT_ANGLE_RAD;
    errors->far_m = maths_max(errors->far_m, far_m);
    errors->turned_rad = maths_max(errors->turned_rad, turned_rad);
}

/* Compares every entity that was sent. */
static void compare(struct errors errors[DOMAIN_COUNT], uint64_t now_ns)
{
    const struct entities *e = &poses.entities;
    assert_int_equal(snapshot_take_poses(&poses, &f.view), 0); /* some cruise */
    for (uint32_t row = 0; row < poses.head.used; row++) {
        if (entities.sent[row].id != 0 && entities.sent[row].id == e->row[row].id)
            compare_row(&errors[f.view.world.kinds[e->row[row].kind].domain], e, row, now_ns);
    }
}

static void judge(enum domain domain, const struct errors *errors)
{
    double all = (double)errors->all, far = (double)errors->far, turned = (double)errors->turned;
    if (errors->all == 0)
        return;
    printf("domain %d: %.3f %% more than 1 m off, %.2f m at most; %.3f %% more than 3 degrees, "
           "%.1f at most\n",
           domain, 100.0 * far / all, errors->far_m, 100.0 * turned / all,
           errors->turned_rad * DEG_PER_RAD);
    assert_true(far <= SHARE_MOST * all);
    assert_true(turned <= SHARE_MOST * all);
    assert_true(errors->far_m <= FAR_MOST_M);
    assert_true(errors->turned_rad <= TURNED_MOST_RAD);
}

static void test_the_default_battle(void **state)
{
    (void)state;
    struct errors errors[DOMAIN_COUNT] = {{0}};
    const char *asked = getenv("FRAMES");
    uint32_t frames = asked ? (uint32_t)strtoul(asked, NULL, 10) : 30 * HZ, vehicles = 0;
    uint64_t now_ns = 1000000000000u, before = 0;
    for (uint32_t i = 0; i < SETTLE + frames; i++) {
        fixture_continue(&f, 1);
        now_ns += FRAME_NS;
        if (i == SETTLE) {
            before = output.udp.sent;
            vehicles = fixture_state(&f).head->used;
        }
        if (i % PASS == 0) {
            assert_true(entity_output_look(&entities, &f.view, now_ns));
            entity_output_send(&entities, &f.view, now_ns);
        } else {
            entity_output_follow(&entities, &f.view, now_ns);
        }
        if (i >= SETTLE)
            compare(errors, now_ns);
    }
    double sent = (double)(output.udp.sent - before) / (double)frames;
    printf("%.1f Entity States a second of %u vehicles, %.2f %% of sending every frame\n",
           HZ * sent, vehicles, 100.0 * sent / vehicles);
    for (int domain = 0; domain < DOMAIN_COUNT; domain++)
        judge((enum domain)domain, &errors[domain]);
    assert_true(sent <= SENT_MOST * vehicles);
}

static int set_up(void **state)
{
    (void)state;
    open_world();
    open_output();
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    entity_output_close(&entities);
    close(output.udp.socket);
    close(listener);
    snapshot_free(&poses);
    fixture_close(&f);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_the_default_battle, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
