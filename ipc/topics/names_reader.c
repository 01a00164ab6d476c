/* The topic of names into a list. */
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
        (void)name_table_learn(names, from.sample); /* without memory no vehicle has a name */
        reader->writer = from.writer;
    }
    /* They are written once: after their writer has left they are asked for again. */
    if (names->told && log_due(&reader->looked_ns, NS_PER_S) &&
        dds_topics_orphaned(reader->reader, reader->writer))
        dds_topics_ask_again(reader->link, TOPIC_NAMES, 0, &reader->reader);
}
