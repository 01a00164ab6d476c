/* The link to DDS: domain with an explicit configuration, participant, partitions, bounded end. */
#include "ipc/topics/dds_link.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/segment/world_partition.h"
#include "ipc/topics/dds_config.h"
#include "ipc/topics/dds_datagrams.h"

#include <ctype.h>
#include <errno.h>
#include <netinet/in.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define CLOSE_LIMIT_S 1u

/* Cyclone DDS reports errors in its log and not in its return codes. Its threads log too. */
static struct {
    pthread_mutex_t lock;
    char last[256]; /* the latest warning or error, without its newline */
    bool quiet;
    uint64_t logged_ns;
} library_log = {.lock = PTHREAD_MUTEX_INITIALIZER};

static volatile sig_atomic_t close_exit_code;

/* Keeps one line of the message. The text may come from any datagram, in any encoding. */
static void keep_text(const char *message)
{
    size_t length = strcspn(message, "\n");
    if (length >= sizeof library_log.last)
        length = sizeof library_log.last - 1;
    for (size_t i = 0; i < length; i++)
        library_log.last[i] = isprint((unsigned char)message[i]) ? message[i] : '?';
    library_log.last[length] = '\0';
}

static void take_log(void *unused, const dds_log_data_t *data)
{
    (void)unused;
    if (!(data->priority & (DDS_LC_FATAL | DDS_LC_ERROR | DDS_LC_WARNING)))
        return;
    (void)pthread_mutex_lock(&library_log.lock);
    keep_text(data->message);
    /* Cyclone DDS aborts after a fatal message. */
    if (!library_log.quiet &&
        (data->priority & DDS_LC_FATAL || log_due(&library_log.logged_ns, NS_PER_S)))
        log_warn("dds: %s", library_log.last);
    (void)pthread_mutex_unlock(&library_log.lock);
}

/* what is a part of DDS, or the configuration file that was refused. */
static int refuse(struct error_text *error, const char *what, dds_return_t code)
{
    (void)pthread_mutex_lock(&library_log.lock);
    int result = error_text_set(error, "DDS %s: %s%s%s", what, dds_strretcode(code),
                                library_log.last[0] ? ": " : "", library_log.last);
    (void)pthread_mutex_unlock(&library_log.lock);
    return result;
}

static int configure(char *text, size_t bytes, const struct dds_link_options *options,
                     struct error_text *error)
{
    char address[INET_ADDRSTRLEN];
    if (options->config && options->interface)
        return error_text_set(error,
                              "--interface %s: not together with --dds-config, whose file "
                              "names the interface",
                              options->interface);
    if (options->config)
        return dds_config_file(text, bytes, options->config, error);
    if (dds_config_interface(address, sizeof address,
                             options->interface ? options->interface : DDS_LOOPBACK, error) != 0)
        return -1;
    return dds_config_builtin(text, bytes, address, options->part, error);
}

/* Returns true if the link is for a world of this user's runtime folder. Only a named network leads
 * to others, and only while the folder has no world of the name. */
static bool is_own(const struct dds_link_options *options, const struct segment_paths *paths)
{
    return (!options->interface && !options->config) || paths->object[0] != '\0';
}

/* Publisher and subscriber have the partitions, and so has every reader and writer made in them. */
static int join_partitions(struct dds_link *link, const struct dds_link_options *options,
                           const char *world, struct error_text *error)
{
    struct segment_paths paths;
    char own[WORLD_PARTITION_MAX];
    if (segment_paths(&paths, world, error) != 0 || world_partition_own(own, world, error) != 0)
        return -1;
    bool host = options->part == DDS_HOST;
    const char *partition[] = {host || is_own(options, &paths) ? own : world, world};
    dds_qos_t *qos = dds_create_qos();
    dds_qset_partition(qos, host ? 2 : 1, partition);
    link->publisher = dds_create_publisher(link->participant, qos, NULL);
    link->subscriber = dds_create_subscriber(link->participant, qos, NULL);
    dds_delete_qos(qos);
    if (link->publisher < 0)
        return refuse(error, "publisher", link->publisher);
    if (link->subscriber < 0)
        return refuse(error, "subscriber", link->subscriber);
    return 0;
}

int dds_link_open(struct dds_link *link, const struct dds_link_options *options, const char *world,
                  struct error_text *error)
{
    char *config = malloc(DDS_CONFIG_MAX);
    if (!config)
        return error_text_set(error, "DDS configuration: out of memory");
    if (configure(config, DDS_CONFIG_MAX, options, error) != 0)
        goto err_config;
    library_log.quiet = true; /* until the link is open: messages go into the reason */
    library_log.last[0] = '\0';
    dds_set_log_sink(take_log, NULL);
    link->secure = dds_config_secure(config);
    /* Without named peers participants are found by multicast, or because they announce
     * themselves. */
    dds_datagrams_begin(!strcasestr(config, "<Peer"));
    link->domain = dds_create_domain(options->domain, config);
    if (link->domain < 0 && strstr(library_log.last, "participant index")) {
        (void)error_text_set(
            error,
            "DDS domain %u: it has %u worlds with reporters on this machine, and has "
            "room for no more; name another, as --domain %u",
            options->domain, DDS_HOSTS, options->domain ? 0 : 1);
        goto err_config;
    }
    if (link->domain < 0) {
        (void)refuse(error, options->config ? options->config : "domain", link->domain);
        goto err_config;
    }
    link->participant = dds_create_participant(options->domain, NULL, NULL);
    if (link->participant < 0) {
        (void)refuse(error, "participant", link->participant);
        goto err_domain;
    }
    if (join_partitions(link, options, world, error) != 0)
        goto err_domain;
    free(config);
    library_log.quiet = options->quiet;
    return 0;

err_domain:
    (void)dds_delete(link->domain);
err_config:
    free(config);
    return -1;
}

static void end_process(int signal_number)
{
    (void)signal_number;
    _exit(close_exit_code);
}

void dds_link_close(struct dds_link *link, int exit_code)
{
    struct sigaction action = {.sa_handler = end_process};
    close_exit_code = exit_code;
    (void)sigaction(SIGALRM, &action, NULL);
    (void)alarm(CLOSE_LIMIT_S);
    (void)dds_delete(link->domain);
    (void)alarm(0);
}
