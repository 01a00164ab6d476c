/* Filters and sorts the list of vehicles and writes a page of it. Only the rows up to the end of
 * the page are kept, in a heap. */
#include "clients/console/vehicles_json.h"

#include "world/entity/kind.h"
#include "world/entity/remote.h"
#include "world/enum_names.h"
#include "world/terrain/gridsquare.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROWS     50u  /* of a page, by default ... */
#define ROWS_MAX 500u /* ... and at most */
#define FROM_MAX 10000u

enum sorting {
    SORT_ID,
    SORT_NAME,
    SORT_KIND,
    SORT_SPEED,
    SORT_DAMAGE,
    SORT_ROUNDS,
    SORT_FUEL,
    SORT_BEHAVIOUR,
    SORT_COUNT
};

static const char *const sort_words[SORT_COUNT] = {"id",     "name",   "kind", "speed",
                                                   "damage", "rounds", "fuel", "behaviour"};

struct list_query {
    const char *search;
    uint32_t force, kind; /* FORCE_COUNT, KIND_NONE: any */
    enum sorting sort;
    bool descending;
    uint64_t from, most;
    bool kind_found[KIND_COUNT_MAX]; /* the kind's name contains the search text */
};

/* A row and its sort key. */
struct entry {
    double key;
    const char *word;                     /* sort key of text columns, else "" */
    char marking[REMOTE_MARKING_MAX + 1]; /* the sort key instead of it, or "" */
    uint32_t row, id;
};

/* --- the query ---------------------------------------------------------------------------------*/

static bool read_sort(const struct world_query *query, struct list_query *list,
                      struct http_answer *answer)
{
    const char *word = query_text(&query->arguments, "sort");
    list->sort = SORT_ID;
    while (*word && list->sort < SORT_COUNT && strcmp(word, sort_words[list->sort]) != 0)
        list->sort++;
    if (list->sort < SORT_COUNT)
        return true;
    http_answer_error(answer, HTTP_ANSWER_BAD,
                      "there are id, name, kind, speed, damage, rounds, fuel, behaviour",
                      "sort=%.40s: nothing to sort by", word);
    return false;
}

static bool read_force(const struct world_query *query, struct list_query *list,
                       struct http_answer *answer)
{
    const char *word = query_text(&query->arguments, "force");
    list->force = *word ? 0 : FORCE_COUNT;
    while (*word && list->force < FORCE_COUNT &&
           strcmp(word, force_name((enum force)list->force)) != 0)
        list->force++;
    if (!*word || list->force < FORCE_COUNT)
        return true;
    http_answer_error(answer, HTTP_ANSWER_BAD, "there are neutral, blue, red",
                      "force=%.40s: no such force", word);
    return false;
}

static bool read_kind(const struct world_query *query, struct list_query *list,
                      struct http_answer *answer)
{
    const struct world *world = &query->reader->view.world;
    const char *word = query_text(&query->arguments, "kind");
    list->kind = *word ? kind_find(world->kinds, world->counts.kinds, word) : KIND_NONE;
    if (!*word || list->kind != KIND_NONE)
        return true;
    http_answer_error(answer, HTTP_ANSWER_BAD, "/api/world lists them", "kind=%.40s: no such kind",
                      word);
    return false;
}

static bool read_asked(const struct world_query *query, struct list_query *list,
                       struct http_answer *answer)
{
    uint64_t descending = 0;
    const struct world *world = &query->reader->view.world;
    *list = (struct list_query){.search = query_text(&query->arguments, "search")};
    if (!read_sort(query, list, answer) || !read_force(query, list, answer) ||
        !read_kind(query, list, answer) ||
        !query_whole(&query->arguments, "descending", 0, 1, 0, &descending, answer) ||
        !query_whole(&query->arguments, "from", 0, FROM_MAX, 0, &list->from, answer) ||
        !query_whole(&query->arguments, "most", 1, ROWS_MAX, ROWS, &list->most, answer))
        return false;
    list->descending = descending != 0;
    for (uint32_t i = 0; i < world->counts.kinds && i < KIND_COUNT_MAX; i++)
        list->kind_found[i] = strcasestr(world->kinds[i].name, list->search) != NULL;
    return true;
}

/* Returns true if the row belongs to the list. The search text is a part of the name or the kind,
 * or the beginning of the id. */
static bool matches(const struct world_query *query, const struct list_query *list, uint32_t row)
{
    const struct entities *e = &query->reader->snapshot.entities;
    const struct world *world = &query->reader->view.world;
    char id[16], marking[REMOTE_MARKING_MAX + 1];
    uint32_t kind = e->row[row].kind;
    if (e->row[row].state == ENTITY_FREE || kind >= world->counts.kinds ||
        world->kinds[kind].domain == DOMAIN_MUNITION ||
        (list->force < FORCE_COUNT && e->row[row].force != list->force) ||
        (list->kind != KIND_NONE && kind != list->kind))
        return false;
    if (list->kind_found[kind] ||
        strcasestr(world_row_name(world, e, row, marking), list->search) != NULL)
        return true;
    (void)snprintf(id, sizeof id, "%u", e->row[row].id);
    return strncmp(id, list->search, strlen(list->search)) == 0;
}

/* --- order -------------------------------------------------------------------------------------*/

static struct entry entry_of(const struct world_query *query, const struct list_query *list,
                             uint32_t row)
{
    const struct entities *e = &query->reader->snapshot.entities;
    const struct world *world = &query->reader->view.world;
    struct entry entry = {.word = "", .row = row, .id = e->row[row].id};
    switch (list->sort) {
    case SORT_NAME:
        entry.word = world_entity_name(world, entry.id);
        remote_marking(e, row, entry.marking);
        if (entry.word[0] == '\0' &&
            entry.marking[0] == '\0') /* vehicles without a name come last in both directions */
            entry.key = list->descending ? -1.0 : 1.0;
        break;
    case SORT_KIND:
        entry.word = world->kinds[e->row[row].kind].name;
        break;
    case SORT_BEHAVIOUR:
        entry.word = behaviour_name((enum behaviour)e->row[row].behaviour);
        break;
    case SORT_SPEED:
        entry.key = vec3_length(entities_velocity(e, row));
        break;
    case SORT_DAMAGE:
        entry.key = e->row[row].damage;
        break;
    case SORT_ROUNDS:
        entry.key = e->row[row].rounds;
        break;
    case SORT_FUEL:
        entry.key = e->row[row].fuel_l;
        break;
    case SORT_ID:
    case SORT_COUNT:
        entry.key = entry.id;
        break;
    }
    return entry;
}

/* Returns a number below 0 if a comes before b. Equal keys are ordered by id, so that pages neither
 * repeat nor miss a row. */
static int compare(const struct entry *a, const struct entry *b, bool descending)
{
    int order = (a->key > b->key) - (a->key < b->key);
    if (order == 0)
        order = strcmp(a->marking[0] ? a->marking : a->word, b->marking[0] ? b->marking : b->word);
    if (order != 0)
        return descending ? -order : order;
    return (a->id > b->id) - (a->id < b->id);
}

/* A heap with the last kept row at its root. */
struct heap {
    struct entry *entry; /* [room] */
    uint32_t count, room;
    bool descending;
};

static void sift_down(struct heap *heap, uint32_t at, uint32_t count)
{
    struct entry *e = heap->entry;
    for (;;) {
        uint32_t child = 2 * at + 1;
        if (child + 1 < count && compare(&e[child], &e[child + 1], heap->descending) < 0)
            child++;
        if (child >= count || compare(&e[at], &e[child], heap->descending) >= 0)
            return;
        struct entry swapped = e[at];
        e[at] = e[child];
        e[child] = swapped;
        at = child;
    }
}

static void heap_add(struct heap *heap, const struct entry *entry)
{
    if (heap->count == heap->room) {
        if (compare(entry, &heap->entry[0], heap->descending) < 0) {
            heap->entry[0] = *entry;
            sift_down(heap, 0, heap->count);
        }
        return;
    }
    uint32_t at = heap->count++;
    while (at > 0 && compare(&heap->entry[(at - 1) / 2], entry, heap->descending) < 0) {
        heap->entry[at] = heap->entry[(at - 1) / 2];
        at = (at - 1) / 2;
    }
    heap->entry[at] = *entry;
}

static void sort(struct heap *heap)
{
    for (uint32_t count = heap->count; count > 1; count--) {
        struct entry last = heap->entry[count - 1];
        heap->entry[count - 1] = heap->entry[0];
        heap->entry[0] = last;
        sift_down(heap, 0, count - 1);
    }
}

/* --- the answer --------------------------------------------------------------------------------*/

static void put_row(struct json_writer *json, const struct world_query *query, uint32_t row)
{
    const struct entities *e = &query->reader->snapshot.entities;
    const struct world *world = &query->reader->view.world;
    const struct player *player = players_driver_of(query->players, e->row[row].id);
    json_writer_begin(json, '{');
    json_writer_key_whole(json, "id", e->row[row].id);
    char marking[REMOTE_MARKING_MAX + 1];
    json_writer_key_word(json, "name", world_row_name(world, e, row, marking));
    json_writer_key_word(json, "kind", world->kinds[e->row[row].kind].name);
    json_writer_key_word(json, "force", force_name((enum force)e->row[row].force));
    json_writer_key_word(json, "behaviour", behaviour_name((enum behaviour)e->row[row].behaviour));
    json_writer_key_word(json, "state", entity_state_name((enum entity_state)e->row[row].state));
    json_writer_key_word(json, "damage", damage_name((enum damage)e->row[row].damage));
    json_writer_key_number(json, "x", e->row[row].x, 1);
    json_writer_key_number(json, "z", e->row[row].z, 1);
    json_writer_key_number(json, "speed_mps", vec3_length(entities_velocity(e, row)), 1);
    json_writer_key_whole(json, "rounds", e->row[row].rounds);
    json_writer_key_number(json, "fuel_l", e->row[row].fuel_l, 1);
    json_writer_key_whole(json, "driven", world_query_driver(query, row));
    json_writer_key_word(json, "player", player ? player->name : "");
    json_writer_end(json, '}');
}

void vehicles_json(const struct world_query *query, struct http_answer *answer)
{
    struct list_query list;
    struct json_writer *json = &answer->json;
    if (!world_query_copied(query, answer) || !read_asked(query, &list, answer))
        return;
    struct heap heap = {.room = (uint32_t)(list.from + list.most), .descending = list.descending};
    heap.entry = malloc(heap.room * sizeof *heap.entry);
    if (!heap.entry) {
        http_answer_error(answer, HTTP_ANSWER_AWAY, "ask for less", "no memory for the list");
        return;
    }
    uint64_t total = 0;
    for (uint32_t row = 0; row < query->reader->snapshot.head.used; row++) {
        if (!matches(query, &list, row))
            continue;
        struct entry entry = entry_of(query, &list, row);
        heap_add(&heap, &entry);
        total++;
    }
    sort(&heap);
    json_writer_begin(json, '{');
    json_writer_key_whole(json, "total", total);
    json_writer_key(json, "rows");
    json_writer_begin(json, '[');
    for (uint64_t i = list.from; i < heap.count; i++)
        put_row(json, query, heap.entry[i].row);
    json_writer_end(json, ']');
    json_writer_end(json, '}');
    free(heap.entry);
}
