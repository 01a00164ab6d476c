/* The configuration of Cyclone DDS: the built-in text, a file, and the choice of the interface. */
#include "ipc/topics/dds_config.h"

#include <arpa/inet.h>
#include <ctype.h>
#include <errno.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <stdio.h>
#include <string.h>

/* Discovery by multicast, data by unicast, and no participant index: this takes any number of
 * processes, works with nothing but lo and no multicast route, and starts without a warning. Shared
 * memory is turned off explicitly, because with it Cyclone DDS waits for a daemon. */
static const char builtin[] = "<CycloneDDS>\n"
                              "  <Domain Id=\"any\">\n"
                              "    <General>\n"
                              "      <Interfaces>\n"
                              "        <NetworkInterface address=\"%s\"%s/>\n"
                              "      </Interfaces>\n"
                              "      <AllowMulticast>%s</AllowMulticast>\n"
                              "    </General>\n"
                              "    <Discovery>\n"
                              "      <ParticipantIndex>%s</ParticipantIndex>\n"
                              "%s"
                              "      <LeaseDuration>2 s</LeaseDuration>\n"
                              "      <SPDPInterval>1 s</SPDPInterval>\n"
                              "    </Discovery>\n"
                              "    <SharedMemory>\n"
                              "      <Enable>false</Enable>\n"
                              "    </SharedMemory>\n"
                              "  </Domain>\n"
                              "</CycloneDDS>\n";

/* The ports of the first DDS_HOSTS participants with an index. */
static const char hosts[] = "      <MaxAutoParticipantIndex>%u</MaxAutoParticipantIndex>\n";
static const char peers[] = "      <Peers><Peer address=\"" DDS_LOOPBACK "\"/></Peers>\n"
                            "      <MaxAutoParticipantIndex>%u</MaxAutoParticipantIndex>\n";

int dds_config_builtin(char *text, size_t bytes, const char *address, enum dds_part part,
                       struct error_text *error)
{
    struct in_addr parsed;
    char more[sizeof peers + 16] = "";
    if (inet_pton(AF_INET, address, &parsed) != 1)
        return error_text_set(error, "interface address '%s': not an IPv4 address like %s", address,
                              DDS_LOOPBACK);
    /* The kernel does not mark lo as capable of multicast, although it is. */
    bool loopback = (ntohl(parsed.s_addr) >> 24) == 127;
    if (!loopback)
        part = DDS_PEER;
    if (part != DDS_PEER)
        (void)snprintf(more, sizeof more, part == DDS_HOST ? hosts : peers, DDS_HOSTS - 1);
    int length =
        snprintf(text, bytes, builtin, address, loopback ? " multicast=\"true\"" : "",
                 part == DDS_OBSERVER ? "false" : "spdp", part == DDS_HOST ? "auto" : "none", more);
    if (length < 0 || (size_t)length >= bytes)
        return error_text_set(error, "DDS configuration: longer than %zu bytes", bytes - 1);
    return 0;
}

int dds_config_file(char *text, size_t bytes, const char *path, struct error_text *error)
{
    FILE *file = fopen(path, "re");
    if (!file)
        return error_text_set(error, "--dds-config %s: %s", path, strerror(errno));
    size_t length = fread(text, 1, bytes - 1, file);
    bool failed = ferror(file) != 0;
    bool more = !failed && fgetc(file) != EOF;
    int code = errno;
    (void)fclose(file);
    text[length] = '\0';
    if (failed)
        return error_text_set(error, "--dds-config %s: %s", path, strerror(code));
    if (more)
        return error_text_set(error, "--dds-config %s: longer than %zu bytes", path, bytes - 1);
    size_t start = 0;
    while (isspace((unsigned char)text[start]))
        start++;
    if (text[start] != '<' || strlen(text) != length)
        return error_text_set(error, "--dds-config %s: not XML; it should begin with <CycloneDDS>",
                              path);
    memmove(text, text + start, length - start + 1);
    return 0;
}

/* Returns true if there is an element of this name outside comments. Cyclone DDS ignores the case
 * of names. */
static bool has_element(const char *text, const char *name)
{
    size_t length = strlen(name);
    while ((text = strchr(text, '<')) != NULL) {
        if (strncmp(text, "<!--", 4) == 0) {
            text = strstr(text + 4, "-->");
            if (!text)
                return false;
        } else if (strncasecmp(text + 1, name, length) == 0 &&
                   strchr(" \t\r\n>", text[1 + length])) {
            return text[1 + length] != '\0';
        }
        text++;
    }
    return false;
}

bool dds_config_secure(const char *text)
{
    bool security = has_element(text, "DDSSecurity") || has_element(text, "Security");
    return security && has_element(text, "IdentityCertificate") && has_element(text, "Governance");
}

/* "lo 127.0.0.1, eth0 10.0.0.5" */
static void list_interfaces(char *text, size_t bytes, const struct ifaddrs *list)
{
    size_t used = 0;
    text[0] = '\0';
    for (const struct ifaddrs *i = list; i; i = i->ifa_next) {
        char address[INET_ADDRSTRLEN];
        struct sockaddr_in in;
        if (!i->ifa_addr || i->ifa_addr->sa_family != AF_INET || !(i->ifa_flags & IFF_UP))
            continue;
        memcpy(&in, i->ifa_addr, sizeof in);
        (void)inet_ntop(AF_INET, &in.sin_addr, address, sizeof address);
        int length =
            snprintf(text + used, bytes - used, "%s%s %s", used ? ", " : "", i->ifa_name, address);
        if (length < 0 || (size_t)length >= bytes - used)
            return;
        used += (size_t)length;
    }
    if (!used)
        (void)snprintf(text, bytes, "none");
}

int dds_config_interface(char *address, size_t bytes, const char *wanted, struct error_text *error)
{
    struct ifaddrs *list;
    if (getifaddrs(&list) != 0)
        return error_text_set(error, "interface '%s': cannot list the interfaces: %s", wanted,
                              strerror(errno));
    int result = -1;
    for (const struct ifaddrs *i = list; i && result != 0; i = i->ifa_next) {
        struct sockaddr_in in;
        if (!i->ifa_addr || i->ifa_addr->sa_family != AF_INET || !(i->ifa_flags & IFF_UP))
            continue;
        memcpy(&in, i->ifa_addr, sizeof in);
        if (inet_ntop(AF_INET, &in.sin_addr, address, (socklen_t)bytes) &&
            (strcmp(address, wanted) == 0 || strcmp(i->ifa_name, wanted) == 0))
            result = 0;
    }
    if (result != 0) {
        char there[256];
        list_interfaces(there, sizeof there, list);
        (void)error_text_set(
            error,
            "interface '%s': no interface that is up has this IPv4 address or name; "
            "there are: %s",
            wanted, there);
    }
    freeifaddrs(list);
    return result;
}
