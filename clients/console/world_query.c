/* Checks that each answer from the world begins with. */
#include "clients/console/world_query.h"

bool world_query_attached(const struct world_query *query, struct http_answer *answer)
{
    if (query->reader->attached)
        return true;
    http_answer_error(
        answer, HTTP_ANSWER_AWAY,
        "start it with jolon start; jolon worlds lists the worlds; this page continues "
        "by itself",
        "%s", query->reader->detail.text);
    return false;
}

/* Returns true if the result is that of a whole frame. */
static bool is_read(const struct world_query *query, struct http_answer *answer, int result)
{
    if (result == 0)
        return true;
    http_answer_error(answer, HTTP_ANSWER_AWAY, "jolon world check tells what is wrong with it",
                      "%s", query->reader->detail.text);
    return false;
}

bool world_query_copied(const struct world_query *query, struct http_answer *answer)
{
    return world_query_attached(query, answer) &&
           is_read(query, answer, world_reader_copy(query->reader, query->now_ns));
}

bool world_query_told(const struct world_query *query, struct http_answer *answer)
{
    return world_query_attached(query, answer) &&
           is_read(query, answer, world_reader_tell(query->reader, query->now_ns));
}

uint32_t world_query_driver(const struct world_query *query, uint32_t row)
{
    const struct entities *e = &query->reader->snapshot.entities;
    if (e->row[row].behaviour != BEHAVIOUR_DRIVEN || e->row[row].driver == 0)
        return 0;
    return query->player && e->row[row].driver == query->player->source ? 2 : 1;
}
