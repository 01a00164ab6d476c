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

/* Worlds of a name are looked for: at most so long, and so long after the last one was found. */
#define SEARCH_NS   (3 * (uint64_t)NS_PER_S)
#define SETTLES_NS  ((uint64_t)NS_PER_S)
#define SEARCH_POLL (20 * (uint64_t)NS_PER_MS)
#define WORLDS_MAX  8u  /* that are told apart */
#define TAKE_MAX    32u /* descriptions of writers at once */

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

/* --- worlds of a name --------------------------------------------------------------------------*/

/* The worlds of a name whose reporters were discovered. */
struct dds_link_search {
    char world[SEGMENT_NAME_MAX];
    char partition[WORLDS_MAX][WORLD_PARTITION_MAX];
    uint32_t count, domain_id;
    dds_entity_t writers; /* reads what DDS tells of every writer in the domain */
    bool told;
};

/* Returns true if this is NAME@FOLDER of the name. */
static bool is_partition_of(const char *partition, const char *world)
{
    size_t length = strlen(world);
    return strncmp(partition, world, length) == 0 && partition[length] == '@' &&
           strspn(partition + length + 1, "0123456789abcdef") == WORLD_PARTITION_DIGITS &&
           partition[length + 1 + WORLD_PARTITION_DIGITS] == '\0';
}

static void add_world(struct dds_link_search *search, const char *partition)
{
    if (!is_partition_of(partition, search->world) || search->count == WORLDS_MAX)
        return;
    for (uint32_t i = 0; i < search->count; i++) {
        if (strcmp(search->partition[i], partition) == 0)
            return;
    }
    (void)snprintf(search->partition[search->count++], WORLD_PARTITION_MAX, "%s", partition);
}

/* Takes the writers that DDS has told of since the last call. */
static void take_writers(struct dds_link_search *search)
{
    void *sample[TAKE_MAX] = {NULL};
    dds_sample_info_t info[TAKE_MAX];
    dds_return_t count;
    while ((count = dds_take(search->writers, sample, info, TAKE_MAX, TAKE_MAX)) > 0) {
        for (dds_return_t i = 0; i < count; i++) {
            const dds_builtintopic_endpoint_t *writer = sample[i];
            uint32_t partitions = 0;
            char **partition = NULL;
            if (!info[i].valid_data || info[i].instance_state != DDS_IST_ALIVE ||
                !dds_qget_partition(writer->qos, &partitions, &partition))
                continue;
            for (uint32_t p = 0; p < partitions; p++) {
                add_world(search, partition[p]);
                dds_free(partition[p]);
            }
            dds_free(partition);
        }
        (void)dds_return_loan(search->writers, sample, count);
    }
}

/* Writes "NAME@FOLDER, NAME@FOLDER". */
static void list_worlds(const struct dds_link_search *search, char *text, size_t bytes)
{
    size_t length = 0;
    for (uint32_t i = 0; i < search->count && length < bytes; i++)
        length += (size_t)snprintf(text + length, bytes - length, "%s%s", i ? ", " : "",
                                   search->partition[i]);
}

/* Looks for the worlds of a name. Sets *found to the partition of the only one, or to that of the
 * name if there is none yet. */
static int search_worlds(struct dds_link *link, const char *world, uint32_t domain,
                         const char **found, struct error_text *error)
{
    char list[WORLDS_MAX * (WORLD_PARTITION_MAX + 2)];
    struct dds_link_search *search = link->search = calloc(1, sizeof *search);
    if (!search)
        return error_text_set(error, "DDS: out of memory");
    (void)snprintf(search->world, sizeof search->world, "%s", world);
    search->domain_id = domain;
    search->writers =
        dds_create_reader(link->participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, NULL, NULL);
    if (search->writers < 0)
        return refuse(error, "reader of writers", search->writers);
    uint64_t begun_ns = clock_now_ns(), changed_ns = begun_ns, now_ns = begun_ns;
    while (search->count ? now_ns - changed_ns < SETTLES_NS : now_ns - begun_ns < SEARCH_NS) {
        uint32_t count = search->count;
        clock_sleep_until_ns(now_ns + SEARCH_POLL);
        take_writers(search);
        now_ns = clock_now_ns();
        changed_ns = search->count > count ? now_ns : changed_ns;
    }
    *found = search->count ? search->partition[0] : world;
    if (search->count < 2)
        return 0;
    list_worlds(search, list, sizeof list);
    return error_text_set(error,
                          "world '%s': DDS domain %u has %u of that name: %s; right would be: "
                          "--partition with one of them, which 'jolon world paths -w %s partition' "
                          "prints where the world runs",
                          world, domain, search->count, list, world);
}

bool dds_link_is_single(const struct dds_link *link)
{
    struct dds_link_search *search = link->search;
    char list[WORLDS_MAX * (WORLD_PARTITION_MAX + 2)];
    if (!search)
        return true;
    take_writers(search);
    if (search->count < 2)
        return true;
    list_worlds(search, list, sizeof list);
    if (!search->told)
        log_warn("world '%s': DDS domain %u has %u of that name now: %s; takes none of them; right "
                 "would be: --partition with one of them",
                 search->world, search->domain_id, search->count, list);
    search->told = true;
    return false;
}

/* --- partitions --------------------------------------------------------------------------------*/

/* Publisher and subscriber have the partitions, and so has every reader and writer made in them. */
static int make_ends(struct dds_link *link, const char **partition, uint32_t count,
                     struct error_text *error)
{
    dds_qos_t *qos = dds_create_qos();
    dds_qset_partition(qos, count, partition);
    link->publisher = dds_create_publisher(link->participant, qos, NULL);
    link->subscriber = dds_create_subscriber(link->participant, qos, NULL);
    dds_delete_qos(qos);
    if (link->publisher < 0)
        return refuse(error, "publisher", link->publisher);
    if (link->subscriber < 0)
        return refuse(error, "subscriber", link->subscriber);
    return 0;
}

static void end_search(struct dds_link *link)
{
    if (link->search && link->search->writers > 0)
        (void)dds_delete(link->search->writers);
    free(link->search);
    link->search = NULL;
}

static int join_partitions(struct dds_link *link, const struct dds_link_options *options,
                           const char *world, struct error_text *error)
{
    struct segment_paths paths;
    char own[WORLD_PARTITION_MAX];
    if (segment_paths(&paths, world, error) != 0 || world_partition_own(own, world, error) != 0)
        return -1;
    const char *partition[] = {own, world};
    if (options->part == DDS_HOST)
        return make_ends(link, partition, 2, error);
    if (options->partition && !is_partition_of(options->partition, world))
        return error_text_set(error,
                              "--partition %.64s: is none of world '%s'; right would be: what "
                              "'jolon world paths -w %s partition' prints where the world runs",
                              options->partition, world, world);
    if (options->partition)
        partition[0] = options->partition;
    else if (!is_own(options, &paths) &&
             search_worlds(link, world, options->domain, partition, error) != 0)
        return -1;
    if (make_ends(link, partition, 1, error) != 0)
        return -1;
    if (link->search && link->search->count)
        end_search(link);
    return 0;
}

int dds_link_open(struct dds_link *link, const struct dds_link_options *options, const char *world,
                  struct error_text *error)
{
    char *config = malloc(DDS_CONFIG_MAX);
    link->search = NULL;
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
    end_search(link);
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
    end_search(link);
    (void)dds_delete(link->domain);
    (void)alarm(0);
}
