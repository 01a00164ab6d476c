/* The frame's contacts in a heap, and their renewal. */
#include "collider/contact.h"

#include <stdlib.h>
#include <string.h>

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

int contacts_init(struct contacts *contacts, uint32_t world_capacity)
{
    *contacts = (struct contacts){0};
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
    free(contacts->heap);
    free(contacts->pair);
    free(contacts->met);
    free(contacts->link);
    free(contacts->head);
    free(contacts->version);
    *contacts = (struct contacts){0};
}

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

int contacts_begin(struct contacts *contacts, const struct broad *broad)
{
    uint32_t total = 0;
    for (int i = 0; i < WORKERS_MAX; i++)
        total += broad->list[i].count;
    contacts->count = 0;
    contacts->link_count = 0;
    contacts->pair_count = 0;
    if (reserve_pairs(contacts, total) != 0)
        return -1;
    for (int i = 0; i < WORKERS_MAX; i++) {
        for (uint32_t n = 0; n < broad->list[i].count; n++) {
            uint32_t index = contacts->pair_count++;
            contacts->pair[index] = broad->list[i].pair[n];
            contacts->met[index] = 0;
            if (link_row(contacts, contacts->pair[index].a, index) != 0)
                return -1;
            if (!(contacts->pair[index].b & PAIR_FIXED) &&
                link_row(contacts, contacts->pair[index].b, index) != 0)
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

/* The one order of contacts, whatever order they were found in. */
static bool earlier(const struct contact *p, const struct contact *q)
{
    if (p->toi != q->toi)
        return p->toi < q->toi;
    if (p->a != q->a)
        return p->a < q->a;
    return p->b < q->b;
}

static int push(struct contacts *contacts, struct contact contact)
{
    void *heap = contacts->heap;
    if (grow(&heap, &contacts->capacity, contacts->count, sizeof *contacts->heap) != 0)
        return -1;
    contacts->heap = heap;
    uint32_t i = contacts->count++;
    while (i > 0 && earlier(&contact, &contacts->heap[(i - 1) / 2])) {
        contacts->heap[i] = contacts->heap[(i - 1) / 2];
        i = (i - 1) / 2;
    }
    contacts->heap[i] = contact;
    return 0;
}

static void pop(struct contacts *contacts)
{
    struct contact last = contacts->heap[--contacts->count];
    uint32_t i = 0;
    for (uint32_t child = 1; child < contacts->count; child = 2 * i + 1) {
        if (child + 1 < contacts->count &&
            earlier(&contacts->heap[child + 1], &contacts->heap[child]))
            child++;
        if (!earlier(&contacts->heap[child], &last))
            break;
        contacts->heap[i] = contacts->heap[child];
        i = child;
    }
    contacts->heap[i] = last;
}

static double radius_of(const struct contact_input *input, uint32_t row)
{
    return input->world->kinds[input->entities->kind[row]].radius_m;
}

/* Sweeps one pair from a time on and keeps its contact, if there is one. */
static int sweep_pair(struct contacts *contacts, const struct contact_input *input, uint32_t index,
                      double from)
{
    struct pair pair = contacts->pair[index];
    const struct path *a = &input->path[pair.a];
    struct contact contact = {.a = pair.a, .b = pair.b, .pair = index + 1};
    double reach = radius_of(input, pair.a);
    bool hit;
    if (contacts->met[index] || input->entities->state[pair.a] == ENTITY_FREE)
        return 0;
    if (pair.b & PAIR_FIXED) {
        const struct fixed_object *object = &input->world->fixed[pair.b & ~PAIR_FIXED];
        struct path still = {.at = {object->x, (double)object->y, object->z}};
        reach += (double)object->radius_m;
        if (input->through_fixed ||
            input->world->kinds[object->kind].rigidity < YIELDING_RIGIDITY) {
            struct vec3 gap = vec3_sub(path_at(a, from), still.at);
            if (vec3_dot(gap, gap) < reach * reach)
                return 0;
        }
        hit = sweep_spheres(a, &still, reach, from, &contact.toi);
    } else {
        if (input->entities->state[pair.b] == ENTITY_FREE)
            return 0;
        reach += radius_of(input, pair.b);
        hit = sweep_spheres(a, &input->path[pair.b], reach, from, &contact.toi);
        contact.version_b = contacts->version[pair.b];
    }
    contact.version_a = contacts->version[pair.a];
    return hit ? push(contacts, contact) : 0;
}

int contacts_find(struct contacts *contacts, const struct contact_input *input)
{
    for (uint32_t i = 0; i < contacts->pair_count; i++) {
        if (sweep_pair(contacts, input, i, 0.0) != 0)
            return -1;
    }
    return 0;
}

int contacts_add_end(struct contacts *contacts, uint32_t row, uint32_t what, double toi)
{
    return push(
        contacts,
        (struct contact){.toi = toi, .a = row, .b = what, .version_a = contacts->version[row]});
}

int contacts_ground(struct contacts *contacts, const struct contact_input *input, uint32_t row)
{
    const struct entities *e = input->entities;
    double toi;
    bool flies = e->behaviour[row] == BEHAVIOUR_FLIGHT ||
                 input->world->kinds[e->kind[row]].domain == DOMAIN_AIR;
    if (!flies || e->state[row] != ENTITY_ACTIVE ||
        !sweep_ground(&input->world->terrain, input->craters, &input->path[row], &toi))
        return 0;
    return contacts_add_end(contacts, row, CONTACT_GROUND, toi);
}

bool contacts_next(struct contacts *contacts, struct contact *contact)
{
    while (contacts->count > 0) {
        *contact = contacts->heap[0];
        pop(contacts);
        bool body = contact->b < PAIR_FIXED;
        if (contact->version_a != contacts->version[contact->a] ||
            (body && contact->version_b != contacts->version[contact->b]))
            continue;
        if (contact->pair != 0)
            contacts->met[contact->pair - 1] = 1;
        return true;
    }
    return false;
}

int contacts_change(struct contacts *contacts, const struct contact_input *input, uint32_t row,
                    double time)
{
    contacts->version[row]++;
    for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
        if (sweep_pair(contacts, input, contacts->link[link - 1].pair, time) != 0)
            return -1;
    }
    return contacts_ground(contacts, input, row);
}

void contacts_drop(struct contacts *contacts, uint32_t row)
{
    contacts->version[row]++;
}
