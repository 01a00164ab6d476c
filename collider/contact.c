/* The frame's contacts in a heap, and their renewal. */
#include "collider/contact.h"

#include <errno.h>
#include <stdatomic.h>
#include <stdlib.h>

#define PAIRS_A_PIECE  16
#define FLIERS_A_PIECE 128

/* Makes room for one more of size bytes; 0, or -1 with errno ENOMEM. */
static int grow(void **array, uint32_t *capacity, uint32_t count, size_t size)
{
    if (count < *capacity)
        return 0;
    uint32_t more = count + count / 2 + 1024;
    void *larger = realloc(*array, more * size);
    if (!larger)
        return -1;
    *array = larger;
    *capacity = more;
    return 0;
}

int contacts_init(struct contacts *contacts, uint32_t world_capacity, struct workers *workers)
{
    *contacts = (struct contacts){.workers = workers};
    contacts->head = calloc(world_capacity, sizeof *contacts->head);
    contacts->version = calloc(world_capacity, sizeof *contacts->version);
    if (!contacts->head || !contacts->version) {
        contacts_free(contacts);
        return -1;
    }
    return 0;
}

void contacts_free(struct contacts *contacts)
{
    free(contacts->heap.contact);
    for (int i = 0; i < WORKERS_MAX; i++)
        free(contacts->found[i].contact);
    free(contacts->pair);
    free(contacts->met);
    free(contacts->swept);
    free(contacts->link);
    free(contacts->head);
    free(contacts->version);
    free(contacts->strayed);
    free(contacts->near.pair);
    *contacts = (struct contacts){0};
}

/* --- pairs -------------------------------------------------------------------------------------*/

static int reserve_pairs(struct contacts *contacts, uint32_t count)
{
    if (count <= contacts->pair_capacity)
        return 0;
    uint32_t capacity = count + count / 2 + 1024;
    struct pair *pair = realloc(contacts->pair, capacity * sizeof *pair);
    if (!pair)
        return -1;
    contacts->pair = pair;
    uint8_t *met = realloc(contacts->met, capacity);
    if (!met)
        return -1;
    contacts->met = met;
    uint32_t *swept = realloc(contacts->swept, capacity * sizeof *swept);
    if (!swept)
        return -1;
    contacts->swept = swept;
    contacts->pair_capacity = capacity;
    return 0;
}

static int link_row(struct contacts *contacts, uint32_t row, uint32_t pair)
{
    void *link = contacts->link;
    if (grow(&link, &contacts->link_capacity, contacts->link_count, sizeof *contacts->link) != 0)
        return -1;
    contacts->link = link;
    contacts->link[contacts->link_count] = (struct contact_link){pair, contacts->head[row]};
    contacts->head[row] = ++contacts->link_count;
    return 0;
}

/* Takes in a pair for which reserve_pairs has made room. */
static int add_pair(struct contacts *contacts, struct pair pair)
{
    uint32_t index = contacts->pair_count++;
    contacts->pair[index] = pair;
    contacts->met[index] = 0;
    contacts->swept[index] = 0;
    if (link_row(contacts, pair.a, index) != 0)
        return -1;
    return pair.b & PAIR_FIXED ? 0 : link_row(contacts, pair.b, index);
}

int contacts_begin(struct contacts *contacts, const struct pair_list *lists, uint32_t list_count)
{
    uint32_t total = 0;
    for (uint32_t i = 0; i < list_count; i++)
        total += lists[i].count;
    contacts->heap.count = 0;
    contacts->link_count = 0;
    contacts->pair_count = 0;
    contacts->stray_count = 0;
    contacts->change = 0;
    if (reserve_pairs(contacts, total) != 0)
        return -1;
    for (uint32_t i = 0; i < list_count; i++) {
        for (uint32_t n = 0; n < lists[i].count; n++) {
            if (add_pair(contacts, lists[i].pair[n]) != 0)
                return -1;
        }
    }
    return 0;
}

void contacts_end(struct contacts *contacts)
{
    for (uint32_t i = 0; i < contacts->pair_count; i++) {
        struct pair pair = contacts->pair[i];
        contacts->head[pair.a] = 0;
        if (!(pair.b & PAIR_FIXED))
            contacts->head[pair.b] = 0;
    }
}

/* --- the heap ----------------------------------------------------------------------------------*/

/* The one order of contacts, whatever order they were found in. */
static bool earlier(const struct contact *p, const struct contact *q)
{
    if (p->touch.toi != q->touch.toi)
        return p->touch.toi < q->touch.toi;
    if (p->a != q->a)
        return p->a < q->a;
    return p->b < q->b;
}

static struct contact *list_room(struct contact_list *list)
{
    void *contact = list->contact;
    if (grow(&contact, &list->capacity, list->count, sizeof *list->contact) != 0)
        return NULL;
    list->contact = contact;
    return &list->contact[list->count++];
}

static int push(struct contacts *contacts, const struct contact *contact)
{
    if (!list_room(&contacts->heap))
        return -1;
    struct contact *heap = contacts->heap.contact;
    uint32_t i = contacts->heap.count - 1;
    while (i > 0 && earlier(contact, &heap[(i - 1) / 2])) {
        heap[i] = heap[(i - 1) / 2];
        i = (i - 1) / 2;
    }
    heap[i] = *contact;
    return 0;
}

static void pop(struct contacts *contacts)
{
    struct contact *heap = contacts->heap.contact;
    uint32_t count = --contacts->heap.count;
    struct contact last = heap[count];
    uint32_t i = 0;
    for (uint32_t child = 1; child < count; child = 2 * i + 1) {
        if (child + 1 < count && earlier(&heap[child + 1], &heap[child]))
            child++;
        if (!earlier(&heap[child], &last))
            break;
        heap[i] = heap[child];
        i = child;
    }
    heap[i] = last;
}

/* --- finding -----------------------------------------------------------------------------------*/

/* Sweeps one pair from a time on; true with its contact when it has one. */
static bool sweep_pair(const struct contacts *contacts, const struct contact_input *input,
                       uint32_t index, double from, struct contact *contact)
{
    const struct pair *pair = &contacts->pair[index];
    const uint8_t *state = input->detect.entities->state;
    bool fixed = pair->b & PAIR_FIXED;
    if (contacts->met[index] >= input->meets || state[pair->a] == ENTITY_FREE ||
        (!fixed && state[pair->b] == ENTITY_FREE) ||
        (fixed && !detect_stands(&input->detect, pair->b & ~PAIR_FIXED)))
        return false;
    *contact = (struct contact){.a = pair->a,
                                .b = pair->b,
                                .pair = index + 1,
                                .version_a = contacts->version[pair->a],
                                .version_b = fixed ? 0 : contacts->version[pair->b]};
    return narrow_touch(&input->detect, input->motion, input->through_fixed, pair, from,
                        &contact->touch);
}

struct job {
    struct contacts *contacts;
    const struct contact_input *input;
    uint64_t tick;
    _Atomic int failed;
};

static int note(struct contacts *contacts, uint32_t worker, const struct contact *contact)
{
    struct contact *room = list_room(&contacts->found[worker]);
    if (!room)
        return -1;
    *room = *contact;
    return 0;
}

static void find_some(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct job *job = context;
    struct contact contact;
    for (uint32_t i = first; i < end; i++) {
        if (sweep_pair(job->contacts, job->input, i, 0.0, &contact) &&
            note(job->contacts, worker, &contact) != 0)
            atomic_store(&job->failed, 1);
    }
}

/* What is found of count things goes into the heap. */
static int find_all(struct job *job, workers_function *find, uint32_t count, uint32_t grain)
{
    struct contacts *contacts = job->contacts;
    for (int i = 0; i < WORKERS_MAX; i++)
        contacts->found[i].count = 0;
    workers_run(contacts->workers, find, job, count, grain);
    if (atomic_load(&job->failed)) {
        errno = ENOMEM;
        return -1;
    }
    for (int i = 0; i < WORKERS_MAX; i++) {
        for (uint32_t n = 0; n < contacts->found[i].count; n++) {
            if (push(contacts, &contacts->found[i].contact[n]) != 0)
                return -1;
        }
    }
    return 0;
}

int contacts_find(struct contacts *contacts, const struct contact_input *input)
{
    struct job job = {.contacts = contacts, .input = input};
    return find_all(&job, find_some, contacts->pair_count, PAIRS_A_PIECE);
}

static struct contact end_of(const struct contacts *contacts, uint32_t row, uint32_t what,
                             double toi)
{
    return (struct contact){
        .touch.toi = toi, .a = row, .b = what, .version_a = contacts->version[row]};
}

int contacts_add_end(struct contacts *contacts, uint32_t row, uint32_t what, double toi)
{
    const struct contact contact = end_of(contacts, row, what, toi);
    return push(contacts, &contact);
}

int contacts_ground(struct contacts *contacts, const struct contact_input *input, uint32_t row)
{
    const struct entities *e = input->detect.entities;
    double toi;
    bool flies = e->behaviour[row] == BEHAVIOUR_FLIGHT ||
                 input->detect.world->kinds[e->kind[row]].domain == DOMAIN_AIR;
    if (!flies || e->state[row] != ENTITY_ACTIVE ||
        !detect_ground(&input->detect, &input->detect.path[row], &toi))
        return 0;
    return contacts_add_end(contacts, row, CONTACT_GROUND, toi);
}

static int find_end(const struct job *job, uint32_t row, uint32_t worker)
{
    const struct entities *e = job->input->detect.entities;
    struct contact contact;
    double toi;
    const struct detect_input *detect = &job->input->detect;
    if (detect_ground(detect, &detect->path[row], &toi)) {
        contact = end_of(job->contacts, row, CONTACT_GROUND, toi);
        if (note(job->contacts, worker, &contact) != 0)
            return -1;
    }
    if (e->behaviour[row] != BEHAVIOUR_FLIGHT || job->tick < e->until_tick[row])
        return 0;
    contact = end_of(job->contacts, row, CONTACT_AIR, 1.0);
    return note(job->contacts, worker, &contact);
}

/* Fliers first .. end - 1 of all lanes' together. */
static void find_some_ends(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct job *job = context;
    const struct broad *broad = job->input->broad;
    uint32_t before = 0;
    for (uint32_t lane = 0; lane < broad->lanes; lane++) {
        const struct pair_list *fliers = &broad->lane[lane].fliers;
        uint32_t i = first > before ? first - before : 0;
        for (; i < fliers->count && before + i < end; i++) {
            if (find_end(job, fliers->pair[i].a, worker) != 0)
                atomic_store(&job->failed, 1);
        }
        before += fliers->count;
    }
}

int contacts_find_ends(struct contacts *contacts, const struct contact_input *input, uint64_t tick)
{
    struct job job = {.contacts = contacts, .input = input, .tick = tick};
    uint32_t count = 0;
    for (uint32_t lane = 0; lane < input->broad->lanes; lane++)
        count += input->broad->lane[lane].fliers.count;
    return find_all(&job, find_some_ends, count, FLIERS_A_PIECE);
}

const struct contact *contacts_peek(struct contacts *contacts)
{
    while (contacts->heap.count > 0) {
        const struct contact *first = &contacts->heap.contact[0];
        bool body = first->b < PAIR_FIXED;
        if (first->version_a == contacts->version[first->a] &&
            (!body || first->version_b == contacts->version[first->b]))
            return first;
        pop(contacts);
    }
    return NULL;
}

bool contacts_next(struct contacts *contacts, const struct contact_input *input,
                   struct contact *contact)
{
    const struct contact *first = contacts_peek(contacts);
    if (!first)
        return false;
    *contact = *first;
    pop(contacts);
    contact->last = contact->pair != 0 && ++contacts->met[contact->pair - 1] >= input->meets;
    return true;
}

void contacts_settle(struct contacts *contacts, const struct contact *contact)
{
    contacts->swept[contact->pair - 1] = contacts->change + 1;
}

/* --- another way -------------------------------------------------------------------------------*/

static bool paired(const struct contacts *contacts, const struct pair *pair)
{
    for (uint32_t link = contacts->head[pair->a]; link != 0; link = contacts->link[link - 1].next) {
        const struct pair *known = &contacts->pair[contacts->link[link - 1].pair];
        if (known->a == pair->a && known->b == pair->b)
            return true;
    }
    return false;
}

static int meet(struct contacts *contacts, const struct contact_input *input, uint32_t row,
                uint32_t other)
{
    bool fixed = other & PAIR_FIXED;
    struct pair pair = {fixed || row < other ? row : other, fixed || row < other ? other : row};
    if (other == row || paired(contacts, &pair))
        return 0;
    if (!fixed)
        motion_draw(input->motion, other);
    if (!fixed && detect_apart(&input->detect, pair.a, pair.b))
        return 0;
    return reserve_pairs(contacts, contacts->pair_count + 1) == 0 ? add_pair(contacts, pair) : -1;
}

static bool box_within(const struct sweep_box *inner, const struct sweep_box *outer)
{
    return inner->min_x >= outer->min_x && inner->max_x <= outer->max_x &&
           inner->min_y >= outer->min_y && inner->max_y <= outer->max_y &&
           inner->min_z >= outer->min_z && inner->max_z <= outer->max_z;
}

static struct sweep_box box_union(const struct sweep_box *a, const struct sweep_box *b)
{
    return (struct sweep_box){
        a->min_x < b->min_x ? a->min_x : b->min_x, a->min_y < b->min_y ? a->min_y : b->min_y,
        a->min_z < b->min_z ? a->min_z : b->min_z, a->max_x > b->max_x ? a->max_x : b->max_x,
        a->max_y > b->max_y ? a->max_y : b->max_y, a->max_z > b->max_z ? a->max_z : b->max_z,
    };
}

/* Pairs the row with whatever its new way comes near: what the broad phase knows, and the rows that
 * have left the boxes that it knows. */
static int look_around(struct contacts *contacts, const struct contact_input *input, uint32_t row)
{
    struct sweep_box *known = &input->broad->box[row];
    struct sweep_box box = detect_box(&input->detect, row);
    bool strays = !box_within(&box, known);
    contacts->near.count = 0;
    if (broad_query(input->broad, &input->detect, &box, &contacts->near) != 0)
        return -1;
    uint32_t rows = contacts->near.count;
    if (broad_query_fixed(input->broad, &input->detect, &box, &contacts->near) != 0)
        return -1;
    for (uint32_t i = 0; i < contacts->near.count; i++) {
        const struct pair *near = &contacts->near.pair[i];
        if (meet(contacts, input, row, i < rows ? near->a : near->b) != 0)
            return -1;
    }
    for (uint32_t i = 0; i < contacts->stray_count; i++) {
        if (detect_boxes_meet(&box, &input->broad->box[contacts->strayed[i]]) &&
            meet(contacts, input, row, contacts->strayed[i]) != 0)
            return -1;
    }
    if (!strays)
        return 0;
    void *strayed = contacts->strayed;
    if (grow(&strayed, &contacts->stray_capacity, contacts->stray_count,
             sizeof *contacts->strayed) != 0)
        return -1;
    contacts->strayed = strayed;
    contacts->strayed[contacts->stray_count++] = row;
    *known = box_union(known, &box);
    return 0;
}

/* Sweeps the row's pairs, but for those that this change has swept from the other side. */
static int sweep_row(struct contacts *contacts, const struct contact_input *input, uint32_t row,
                     double time)
{
    struct contact contact;
    for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
        uint32_t pair = contacts->link[link - 1].pair;
        if (contacts->swept[pair] == contacts->change)
            continue;
        contacts->swept[pair] = contacts->change;
        if (sweep_pair(contacts, input, pair, time, &contact) && push(contacts, &contact) != 0)
            return -1;
    }
    return contacts_ground(contacts, input, row);
}

int contacts_change(struct contacts *contacts, const struct contact_input *input,
                    const uint32_t *rows, uint32_t count, double time)
{
    enum method method = (enum method)input->detect.world->params->collision.method;
    contacts->change++;
    for (uint32_t i = 0; i < count; i++)
        contacts->version[rows[i]]++;
    for (uint32_t i = 0; i < count; i++) {
        if ((!detect_discrete(method) && look_around(contacts, input, rows[i]) != 0) ||
            sweep_row(contacts, input, rows[i], time) != 0)
            return -1;
    }
    return 0;
}

void contacts_drop(struct contacts *contacts, uint32_t row)
{
    contacts->version[row]++;
}
