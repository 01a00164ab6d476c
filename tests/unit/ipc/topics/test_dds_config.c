/* The configuration of Cyclone DDS: the installed file is the built-in text, and wrong values are
 * refused by name. */
#include "ipc/topics/dds_config.c" /* the unit tests are not linked with the processes */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

static char text[DDS_CONFIG_MAX];
static struct error_text error;

/* Writes a new file and returns its name. */
static const char *file_of(const char *content, size_t bytes)
{
    static char path[] = "/tmp/jolon-test-XXXXXX";
    (void)strcpy(path + sizeof path - 7, "XXXXXX");
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, content, bytes), bytes);
    (void)close(fd);
    return path;
}

static void test_installed_file_is_the_built_in_text(void **state)
{
    static char file[DDS_CONFIG_MAX];
    (void)state;
    assert_int_equal(dds_config_builtin(text, sizeof text, DDS_LOOPBACK, DDS_PEER, &error), 0);
    assert_int_equal(dds_config_file(file, sizeof file, "config/cyclonedds.xml", &error), 0);
    assert_string_equal(text, file);
}

static void test_another_interface(void **state)
{
    (void)state;
    assert_int_equal(dds_config_builtin(text, sizeof text, "10.1.2.3", DDS_PEER, &error), 0);
    assert_non_null(strstr(text, "address=\"10.1.2.3\"/>"));
    /* Only an address is put into the XML. */
    assert_int_equal(dds_config_builtin(text, sizeof text, "1.2.3.4\"/><x", DDS_PEER, &error), -1);
    assert_non_null(strstr(error.text, "not an IPv4 address"));
    assert_int_equal(dds_config_builtin(text, 10, DDS_LOOPBACK, DDS_PEER, &error), -1);
}

/* Observers ask at the ports of hosts, and only hosts hear them. */
static void test_observers_and_hosts(void **state)
{
    (void)state;
    assert_int_equal(dds_config_builtin(text, sizeof text, DDS_LOOPBACK, DDS_OBSERVER, &error), 0);
    assert_non_null(strstr(text, "<AllowMulticast>false</AllowMulticast>"));
    assert_non_null(strstr(text, "<ParticipantIndex>none</ParticipantIndex>"));
    assert_non_null(strstr(text, "<Peer address=\"127.0.0.1\"/>"));
    assert_non_null(strstr(text, "<MaxAutoParticipantIndex>63</MaxAutoParticipantIndex>"));
    assert_int_equal(dds_config_builtin(text, sizeof text, DDS_LOOPBACK, DDS_HOST, &error), 0);
    assert_non_null(strstr(text, "<AllowMulticast>spdp</AllowMulticast>"));
    assert_non_null(strstr(text, "<ParticipantIndex>auto</ParticipantIndex>"));
    assert_non_null(strstr(text, "<MaxAutoParticipantIndex>63</MaxAutoParticipantIndex>"));
    assert_null(strstr(text, "Peer"));
    /* Hosts on other machines are found by multicast only. */
    assert_int_equal(dds_config_builtin(text, sizeof text, "10.1.2.3", DDS_OBSERVER, &error), 0);
    assert_non_null(strstr(text, "<AllowMulticast>spdp</AllowMulticast>"));
    assert_null(strstr(text, "Peer"));
}

static void test_interfaces(void **state)
{
    char address[16];
    (void)state;
    assert_int_equal(dds_config_interface(address, sizeof address, "no-such0", &error), -1);
    assert_non_null(strstr(error.text, "no-such0"));
    if (dds_config_interface(address, sizeof address, "lo", &error) == 0)
        assert_string_equal(address, DDS_LOOPBACK);
}

static void test_files_refused(void **state)
{
    static char big[DDS_CONFIG_MAX + 10];
    (void)state;
    assert_int_equal(dds_config_file(text, sizeof text, "/nonexistent/x.xml", &error), -1);
    assert_non_null(strstr(error.text, "/nonexistent/x.xml: No such file"));
    assert_int_equal(dds_config_file(text, sizeof text, "/tmp", &error), -1);

    const char *path = file_of("file:///etc/x.xml", 17);
    assert_int_equal(dds_config_file(text, sizeof text, path, &error), -1);
    assert_non_null(strstr(error.text, "not XML"));
    (void)unlink(path);

    path = file_of("<a>\0</a>", 8);
    assert_int_equal(dds_config_file(text, sizeof text, path, &error), -1);
    (void)unlink(path);

    path = file_of("  \n<CycloneDDS/>", 16);
    assert_int_equal(dds_config_file(text, sizeof text, path, &error), 0);
    assert_string_equal(text, "<CycloneDDS/>");
    (void)unlink(path);

    memset(big, '<', sizeof big);
    path = file_of(big, sizeof big);
    assert_int_equal(dds_config_file(text, sizeof text, path, &error), -1);
    assert_non_null(strstr(error.text, "longer than"));
    (void)unlink(path);
}

static void test_security_is_seen(void **state)
{
    static const struct {
        const char *text;
        bool secure;
    } cases[] = {
        {"<CycloneDDS><Domain><DDSSecurity><Authentication><IdentityCertificate>file:a"
         "</IdentityCertificate></Authentication><AccessControl><Governance>file:b</Governance>"
         "</AccessControl></DDSSecurity></Domain></CycloneDDS>",
         true},
        {"<security ><identitycertificate\n><governance>", true},
        {"<DDSSecurity><IdentityCertificate>", false},
        {"<DDSSecurity><IdentityCertificate><Governance/>", false},
        {"<DDSSecurityNot><IdentityCertificate><Governance>", false},
        {"<!-- <DDSSecurity> --><IdentityCertificate><Governance>", false},
        {"<!-- <DDSSecurity><IdentityCertificate><Governance>", false},
        {"<!-- a --><DDSSecurity><!-- > --><IdentityCertificate><Governance>", true},
        {"<DDSSecurity><IdentityCertificate><Governance", false},
        {"", false},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        if (dds_config_secure(cases[i].text) != cases[i].secure)
            fail_msg("%s: should be %s", cases[i].text, cases[i].secure ? "secure" : "not secure");
    }
    assert_int_equal(dds_config_builtin(text, sizeof text, DDS_LOOPBACK, DDS_HOST, &error), 0);
    assert_false(dds_config_secure(text));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_installed_file_is_the_built_in_text),
        cmocka_unit_test(test_another_interface),
        cmocka_unit_test(test_observers_and_hosts),
        cmocka_unit_test(test_interfaces),
        cmocka_unit_test(test_files_refused),
        cmocka_unit_test(test_security_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
