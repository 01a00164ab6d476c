/* The stream's clients, in one process with it: what is encoded when, and that it ends whatever
 * they do. How browsers and hostile clients fare is tested by tests/system/test_video.sh. */
#include "renderer/output/stream.h"

#include "ipc/http/listen.h"
#include "ipc/process/clock.h"
#include "renderer/output/stream_listen.h"
#include "renderer/output/stream_requests.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cmocka.h>

#define ANSWER_BYTES 65536

static struct picture_pool pool;
static struct stream *stream;
static struct image image;
static struct error_text error;
static char answer[ANSWER_BYTES];

static int set_up(void **state)
{
    (void)state;
    picture_pool_init(&pool);
    stream = stream_open("world", NULL, &error);
    return stream != NULL && stream_listen(stream, HTTP_LISTEN_ADDRESS, 0, &error) == 0 &&
                   stream_start(stream, &error) == 0 && image_init(&image, 64, 48) == 0
               ? 0
               : -1;
}

/* Every picture must have been released. */
static int tear_down(void **state)
{
    (void)state;
    stream_close(stream);
    picture_pool_free(&pool);
    image_free(&image);
    return 0;
}

static void show(const char *view, uint64_t frame)
{
    struct picture *picture = picture_make(&pool, &image, view, "");
    assert_non_null(picture);
    picture->frame = frame;
    picture->time_s = (double)frame / 60.0;
    stream_put(stream, picture);
    picture_release(picture);
}

/* Returns a connection that has requested a path. */
static int ask(const char *path)
{
    char request[128];
    const struct timeval patience = {.tv_sec = 10};
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    const char *port = strrchr(stream_url(stream), ':');
    address.sin_port = htons((uint16_t)strtoul(port + 1, NULL, 10));
    int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    assert_true(fd >= 0);
    assert_int_equal(connect(fd, (struct sockaddr *)&address, sizeof address), 0);
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    int length = snprintf(request, sizeof request,
                          "GET %s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n", path);
    assert_int_equal(send(fd, request, (size_t)length, 0), length);
    return fd;
}

/* Returns all that is received until the other side closes. */
static const char *fetch(const char *path)
{
    int fd = ask(path);
    size_t used = 0;
    ssize_t got;
    while ((got = recv(fd, answer + used, sizeof answer - 1 - used, 0)) > 0)
        used += (size_t)got;
    answer[used] = '\0';
    close(fd);
    return answer;
}

static void wait_for(int fd, const char *words)
{
    size_t used = 0;
    while (memmem(answer, used, words, strlen(words)) == NULL) {
        ssize_t got = recv(fd, answer + used, sizeof answer - used, 0);
        if (got <= 0)
            fail_msg("\"%s\" does not come", words);
        used += (size_t)got;
    }
}

static void check_status(const char *words)
{
    if (strstr(fetch("/status.json"), words) == NULL)
        fail_msg("%s is not in %s", words, answer);
}

static void test_a_picture_is_encoded_when_asked_for_and_once(void **state)
{
    (void)state;
    for (uint64_t frame = 1; frame <= 5; frame++)
        show("chase", frame);
    check_status("\"drawn\":5,\"encoded\":0");
    for (int i = 0; i < 3; i++)
        assert_non_null(strstr(fetch("/chase.jpg"), "200 OK"));
    check_status("\"frame\":5,\"time_s\":0.0833");
    check_status("\"drawn\":5,\"encoded\":1");
    show("chase", 6);
    check_status("\"drawn\":6,\"encoded\":1");
}

static void test_watchers_share_one_encoding(void **state)
{
    (void)state;
    show("chase.17", 1);
    int first = ask("/chase.17.mjpeg"), second = ask("/chase.17.mjpeg");
    wait_for(first, "X-Frame: 1\r\n");
    wait_for(second, "X-Frame: 1\r\n");
    show("chase.17", 2);
    wait_for(first, "X-Frame: 2\r\n");
    wait_for(second, "X-Frame: 2\r\n");
    check_status("\"watchers\":2,\"views\"");
    check_status("\"drawn\":2,\"encoded\":2");
    close(first);
    close(second);
}

static void test_there_is_what_was_shown(void **state)
{
    (void)state;
    assert_non_null(strstr(fetch("/"), "http-equiv=\"refresh\""));
    assert_non_null(strstr(fetch("/map.jpg"), "404 Not Found"));
    show("map", 1);
    show("<script>", 1);
    assert_non_null(strstr(fetch("/"), "src=\"/map.mjpeg\""));
    assert_null(strstr(answer, "<script>"));
    assert_null(strstr(answer, "refresh"));
}

static void test_more_than_may_watch_are_told(void **state)
{
    int fd[20];
    (void)state;
    show("map", 1);
    for (int i = 0; i < 16; i++) {
        fd[i] = ask("/map.mjpeg");
        wait_for(fd[i], "X-Frame: 1\r\n");
    }
    assert_non_null(strstr(fetch("/map.mjpeg"), "503 Service Unavailable"));
    assert_non_null(strstr(fetch("/map.jpg"), "200 OK"));
    for (int i = 0; i < 16; i++)
        close(fd[i]);
}

/* --- requested pictures; the test is the drawing thread --- */

static struct stream_request requests[PICTURE_REQUESTS_MAX];

/* Returns the row of a vehicle's picture that a client waits for. */
static uint32_t wait_for_wish(uint32_t vehicle)
{
    for (int tries = 0; tries < 1000; tries++) {
        stream_requests_read(stream, requests);
        for (uint32_t i = 0; i < PICTURE_REQUESTS_MAX; i++)
            if (requests[i].waiting && requests[i].key.vehicle == vehicle)
                return i;
        stream_requests_wait(stream, clock_now_ns() + 10000000u);
    }
    fail_msg("nobody waits for vehicle %u", vehicle);
    return 0;
}

static void grant(uint32_t row, uint64_t frame)
{
    struct picture *picture = picture_make(&pool, &image, "asked", "");
    assert_non_null(picture);
    picture->frame = frame;
    stream_requests_answer(stream, row, requests[row].generation, picture);
    picture_release(picture);
}

static void test_a_picture_is_drawn_for_who_waits(void **state)
{
    (void)state;
    assert_int_equal(stream_requests_read(stream, requests), 0);
    int one = ask("/picture.jpg?view=inside&vehicle=17&size=100x80&bar=0");
    uint32_t row = wait_for_wish(17);
    assert_int_equal(requests[row].key.view, VIEW_INSIDE);
    assert_int_equal(requests[row].key.width, 100);
    assert_false(requests[row].key.bar);
    assert_true(requests[row].again);
    grant(row, 5);
    wait_for(one, "X-Picture: 1\r\nX-Frame: 5\r\n");
    close(one);
    /* The next picture is new; clients that request the same one share it. */
    one = ask("/picture.jpg?view=inside&vehicle=17&size=100x80&bar=0&after=1");
    int two = ask("/picture.jpg?view=inside&vehicle=17&size=100x80&bar=0&after=1");
    assert_int_equal(wait_for_wish(17), row);
    assert_false(requests[row].again);
    grant(row, 6);
    wait_for(one, "X-Picture: 2\r\n");
    wait_for(two, "X-Picture: 2\r\n");
    assert_int_equal(stream_requests_read(stream, requests), 0);
    close(one);
    close(two);
}

static void test_who_waits_for_what_is_not_there_is_told(void **state)
{
    (void)state;
    int fd = ask("/picture.jpg?vehicle=17");
    uint32_t row = wait_for_wish(17);
    stream_requests_answer(stream, row, requests[row].generation + 1, NULL); /* another's answer */
    assert_int_equal(wait_for_wish(17), row);
    stream_requests_answer(stream, row, requests[row].generation, NULL);
    wait_for(fd, "there is no vehicle 17, or no more\n");
    assert_non_null(memmem(answer, sizeof answer, "404 Not Found", 13));
    close(fd);
    assert_non_null(strstr(fetch("/picture.jpg?vehicle=a"), "400 Bad Request"));
    assert_non_null(strstr(answer, "vehicle=a: is a vehicle's number, as 17\n"));
    assert_non_null(strstr(fetch("/map.jpg?x=1"), "404 Not Found")); /* no painter */
}

static void test_a_ninth_picture_is_refused(void **state)
{
    char path[64];
    int fd[PICTURE_REQUESTS_MAX];
    (void)state;
    for (uint32_t i = 0; i < PICTURE_REQUESTS_MAX; i++) {
        snprintf(path, sizeof path, "/picture.jpg?vehicle=%u", i + 1);
        fd[i] = ask(path);
        wait_for_wish(i + 1);
    }
    assert_non_null(strstr(fetch("/picture.jpg?vehicle=9"), "503 Service Unavailable"));
    assert_non_null(strstr(answer, "8 different pictures are drawn already"));
    assert_int_equal(stream_requests_read(stream, requests), PICTURE_REQUESTS_MAX);
    for (uint32_t i = 0; i < PICTURE_REQUESTS_MAX; i++) {
        grant(i, i);
        wait_for(fd[i], "200 OK");
        close(fd[i]);
    }
}

/* tear_down() ends the stream meanwhile. */
static void test_it_ends_with_clients_in_every_state(void **state)
{
    (void)state;
    for (uint64_t frame = 1; frame < 50; frame++) {
        show("map", frame);
        if (frame % 10 == 1)
            (void)ask("/map.mjpeg"); /* never read from, never closed */
        if (frame % 10 == 2)
            close(ask("/map.mjpeg"));
        if (frame % 10 == 3)
            (void)ask("/map.jpg");
        if (frame % 10 == 4)
            (void)ask("/picture.jpg");
    }
}

static void test_what_cannot_be_listened_on_is_said(void **state)
{
    unsigned port = (unsigned)strtoul(strrchr(stream_url(stream), ':') + 1, NULL, 10);
    (void)state;
    struct stream *other = stream_open("world", NULL, &error);
    assert_int_equal(stream_listen(other, HTTP_LISTEN_ADDRESS, (uint16_t)port, &error), -1);
    assert_non_null(strstr(error.text, "it is in use; name another"));
    assert_int_equal(stream_listen(other, "localhost", 0, &error), -1);
    assert_non_null(strstr(error.text, "must be an address"));
    assert_int_equal(stream_listen(other, "192.0.2.1", 0, &error), -1);
    assert_non_null(strstr(error.text, "cannot listen on 192.0.2.1"));
    stream_close(other);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_a_picture_is_encoded_when_asked_for_and_once),
        TEST(test_watchers_share_one_encoding),
        TEST(test_there_is_what_was_shown),
        TEST(test_more_than_may_watch_are_told),
        TEST(test_a_picture_is_drawn_for_who_waits),
        TEST(test_who_waits_for_what_is_not_there_is_told),
        TEST(test_a_ninth_picture_is_refused),
        TEST(test_it_ends_with_clients_in_every_state),
        TEST(test_what_cannot_be_listened_on_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
