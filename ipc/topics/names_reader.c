/* Reads the topic EntityNames. */
#include "ipc/topics/names_reader.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/topics/samples.h"

int names_reader_open(struct names_reader *reader, const struct dds_link *link,
                      struct error_text *error)
{
    *reader =
        (struct names_reader){.link = link, .reader = dds_topics_reader(link, TOPIC_NAMES, error)};
    return reader->reader < 0 ? -1 : 0;
}

void names_reader_take(struct names_reader *reader, struct name_table *names)
{
    struct samples from = {.reader = reader->reader, .topic = TOPIC_NAMES};
    while (samples_next(&from)) {
        (void)name_table_copy(names, from.sample); /* without memory no vehicle has a name */
        reader->writer = from.writer;
    }
    /* Names are written once. When their writer has left, a new reader gets them from its
     * successor. */
    if (names->known && log_due(&reader->looked_ns, NS_PER_S) &&
        dds_topics_writer_left(reader->reader, reader->writer))
        dds_topics_reopen(reader->link, TOPIC_NAMES, 0, &reader->reader);
}
