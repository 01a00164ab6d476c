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

bool world_query_copied(const struct world_query *query, struct http_answer *answer)
{
    if (!world_query_attached(query, answer))
        return false;
    if (world_reader_copy(query->reader, query->now_ns) == 0)
        return true;
    http_answer_error(answer, HTTP_ANSWER_AWAY, "jolon world check tells what is wrong with it",
                      "%s", query->reader->detail.text);
    return false;
}

uint32_t world_query_driver(const struct world_query *query, uint32_t row)
{
    const struct entities *e = &query->reader->snapshot.entities;
    if (e->behaviour[row] != BEHAVIOUR_DRIVEN || e->driver[row] == 0)
        return 0;
    return query->player && e->driver[row] == query->player->source ? 2 : 1;
}
