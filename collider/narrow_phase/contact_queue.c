/* The frame's contacts in a heap, and the search for new ones after a change of path. */
#include "collider/narrow_phase/contact_queue.h"

#include "collider/method/method.h"
#include "collider/motion/ground_impact.h"
#include "world/entity/kind.h"
#include "world/params.h"
#include "world/runtime/check.h"
#include "world/runtime/reserve.h"
#include "world/runtime/work_done.h"
#include "world/world.h"

#include <errno.h>
#include <stdatomic.h>
#include <stdlib.h>

#define PAIRS_A_PIECE  16
#define FLIERS_A_PIECE 128

/* Room for the points of resting pairs. A pair for which there is none is swept always. */
#define REST_POINTS_A_SLOT 8u

/* The two ends of a row's path: ground, and end of life. */
#define ENDS_A_ROW 2u

/* Most contacts in the queue: one of each pair, two ends of each row, and as many void ones. */
#define HEAP_MAX (2u * (PAIRS_MAX + ENDS_A_ROW * CAPACITY_MAX))

/* Returns the greatest number of valid contacts: each pair has at most one, and each row two
 * ends. */
static uint32_t valid_most(const struct contact_queue *contacts, uint32_t pairs)
{
    return pairs + ENDS_A_ROW * contacts->rows;
}

int contact_queue_init(struct contact_queue *contacts, const struct world *world,
                       struct thread_pool *workers)
{
    uint32_t rows = world->params->capacity, pairs = pair_filter_pairs_first(world);
    *contacts = (struct contact_queue){.workers = workers, .rows = rows, .pair_capacity = pairs};
    contacts->heap.capacity = 2 * valid_most(contacts, pairs);
    contacts->heap.contact = reserve_take(contacts->heap.capacity, sizeof *contacts->heap.contact);
    contacts->pair = reserve_take(pairs, sizeof *contacts->pair);
    contacts->met = reserve_take(pairs, sizeof *contacts->met);
    contacts->swept = reserve_take(pairs, sizeof *contacts->swept);
    contacts->marks = reserve_take(pairs, sizeof *contacts->marks);
    contacts->impacts = reserve_take(pairs, sizeof *contacts->impacts);
    contacts->known = reserve_take(pairs, sizeof *contacts->known);
    contacts->rest = reserve_take(pairs, sizeof *contacts->rest);
    contacts->rest_capacity = REST_POINTS_A_SLOT * world->params->contact_slots;
    contacts->rest_point = reserve_take(contacts->rest_capacity, sizeof *contacts->rest_point);
    contacts->proves = world->params->collision.shape == SHAPE_MODEL &&
                       !method_discrete((enum method)world->params->collision.method);
    contacts->link = reserve_take(2 * (uint64_t)pairs, sizeof *contacts->link);
    contacts->head = calloc(rows, sizeof *contacts->head);
    contacts->version = calloc(rows, sizeof *contacts->version);
    contacts->strayed = reserve_take(rows, sizeof *contacts->strayed);
    contacts->strays = calloc(rows, sizeof *contacts->strays);
    if (contacts->heap.contact && contacts->pair && contacts->met && contacts->swept &&
        contacts->marks && contacts->impacts && contacts->known && contacts->rest &&
        contacts->rest_point && contacts->link && contacts->head && contacts->version &&
        contacts->strayed && contacts->strays && pair_apart_init(&contacts->apart, world) == 0 &&
        pair_list_init(&contacts->near, broad_phase_found_most(world)) == 0)
        return 0;
    contact_queue_free(contacts);
    errno = ENOMEM;
    return -1;
}

void contact_queue_free(struct contact_queue *contacts)
{
    reserve_free(contacts->heap.contact);
    reserve_free(contacts->pair);
    reserve_free(contacts->met);
    reserve_free(contacts->swept);
    reserve_free(contacts->marks);
    reserve_free(contacts->impacts);
    reserve_free(contacts->known);
    reserve_free(contacts->rest);
    reserve_free(contacts->rest_point);
    pair_apart_free(&contacts->apart);
    reserve_free(contacts->link);
    free(contacts->head);
    free(contacts->version);
    reserve_free(contacts->strayed);
    free(contacts->strays);
    pair_list_free(&contacts->near);
    *contacts = (struct contact_queue){0};
}

/* --- pairs -------------------------------------------------------------------------------------*/

static void link_row(struct contact_queue *contacts, uint32_t row, uint32_t pair)
{
    contacts->link[contacts->link_count] = (struct contact_link){pair, contacts->head[row]};
    contacts->head[row] = ++contacts->link_count;
}

static void more_pairs(struct contact_queue *contacts)
{
    uint32_t held = contacts->pair_count, more = 2 * contacts->pair_capacity + 1;
    CHECK(held < PAIRS_MAX);
    contacts->pair = reserve_grow(contacts->pair, held, more, sizeof *contacts->pair);
    contacts->met = reserve_grow(contacts->met, held, more, sizeof *contacts->met);
    contacts->swept = reserve_grow(contacts->swept, held, more, sizeof *contacts->swept);
    contacts->marks = reserve_grow(contacts->marks, held, more, sizeof *contacts->marks);
    contacts->impacts = reserve_grow(contacts->impacts, held, more, sizeof *contacts->impacts);
    contacts->known = reserve_grow(contacts->known, held, more, sizeof *contacts->known);
    contacts->rest = reserve_grow(contacts->rest, held, more, sizeof *contacts->rest);
    contacts->link = reserve_grow(contacts->link, contacts->link_count, 2 * (uint64_t)more,
                                  sizeof *contacts->link);
    contacts->pair_capacity = more;
}

static uint32_t add_pair(struct contact_queue *contacts, struct pair pair)
{
    if (contacts->pair_count == contacts->pair_capacity)
        more_pairs(contacts);
    uint32_t index = contacts->pair_count++;
    contacts->pair[index] = pair;
    contacts->met[index] = 0;
    contacts->swept[index] = 0;
    contacts->marks[index] = 0;
    contacts->impacts[index] = (struct pair_impacts){0};
    contacts->known[index] = (struct pair_known){.before_m = PAIR_NOT_MEASURED};
    contacts->rest[index] = (struct rest_span){0, 0};
    link_row(contacts, pair.a, index);
    if (!(pair.b & PAIR_FIXED))
        link_row(contacts, pair.b, index);
    return index;
}

void contact_queue_begin(struct contact_queue *contacts, const struct pair_list *lists,
                         uint32_t list_count)
{
    for (uint32_t i = 0; i < contacts->stray_count; i++)
        contacts->strays[contacts->strayed[i]] = 0;
    contacts->heap.count = 0;
    contacts->link_count = 0;
    contacts->pair_count = 0;
    contacts->stray_count = 0;
    contacts->change = 0;
    contacts->rest_points = 0;
    for (uint32_t i = 0; i < list_count; i++) {
        for (uint32_t n = 0; n < lists[i].count; n++)
            add_pair(contacts, lists[i].pair[n]);
    }
}

void contact_queue_end(struct contact_queue *contacts)
{
    for (uint32_t i = 0; i < contacts->pair_count; i++) {
        struct pair pair = contacts->pair[i];
        contacts->head[pair.a] = 0;
        pair_apart_forget(&contacts->apart, pair.a);
        if (pair.b & PAIR_FIXED)
            continue;
        contacts->head[pair.b] = 0;
        pair_apart_forget(&contacts->apart, pair.b);
    }
}

/* --- the heap ----------------------------------------------------------------------------------*/

/* A total order of contacts, independent of the order in which they were found. */
static bool earlier(const struct contact *p, const struct contact *q)
{
    if (p->impact.toi != q->impact.toi)
        return p->impact.toi < q->impact.toi;
    if (p->a != q->a)
        return p->a < q->a;
    return p->b < q->b;
}

/* Returns true if the contact was computed from the present paths of its bodies. */
static bool is_valid(const struct contact_queue *contacts, const struct contact *contact)
{
    return contact->version_a == contacts->version[contact->a] &&
           (contact->b >= PAIR_FIXED || contact->version_b == contacts->version[contact->b]);
}

/* Puts a contact into the free place i or a place below it. */
static void sift_down(struct contact *heap, uint32_t count, uint32_t i, struct contact contact)
{
    for (uint32_t child = 2 * i + 1; child < count; child = 2 * i + 1) {
        if (child + 1 < count && earlier(&heap[child + 1], &heap[child]))
            child++;
        if (!earlier(&heap[child], &contact))
            break;
        heap[i] = heap[child];
        i = child;
    }
    heap[i] = contact;
}

/* Makes a heap of contacts in any order. */
static void order_heap(struct contact_list *heap)
{
    for (uint32_t i = heap->count / 2; i > 0; i--)
        sift_down(heap->contact, heap->count, i - 1, heap->contact[i - 1]);
}

static void drop_void(struct contact_queue *contacts)
{
    struct contact_list *heap = &contacts->heap;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < heap->count; i++) {
        if (is_valid(contacts, &heap->contact[i]))
            heap->contact[kept++] = heap->contact[i];
    }
    heap->count = kept;
    order_heap(heap);
}

/* Makes room in the heap's array for this many more contacts. */
static void make_room(struct contact_list *heap, uint32_t more)
{
    uint64_t needed = (uint64_t)heap->count + more;
    if (needed <= heap->capacity)
        return;
    CHECK(needed <= HEAP_MAX);
    heap->contact = reserve_grow(heap->contact, heap->count, 2 * needed, sizeof *heap->contact);
    heap->capacity = (uint32_t)(2 * needed);
}

static void push(struct contact_queue *contacts, const struct contact *contact)
{
    if (contacts->heap.count >= 2 * valid_most(contacts, contacts->pair_count))
        drop_void(contacts);
    make_room(&contacts->heap, 1);
    struct contact *heap = contacts->heap.contact;
    uint32_t i = contacts->heap.count++;
    while (i > 0 && earlier(contact, &heap[(i - 1) / 2])) {
        heap[i] = heap[(i - 1) / 2];
        i = (i - 1) / 2;
    }
    heap[i] = *contact;
}

static void pop(struct contact_queue *contacts)
{
    struct contact_list *heap = &contacts->heap;
    heap->count--;
    sift_down(heap->contact, heap->count, 0, heap->contact[heap->count]);
}

/* --- finding -----------------------------------------------------------------------------------*/

/* Returns the velocity of a row's skin at a contact [m/s]. */
static struct vec3 skin_velocity(const struct contact_input *input, uint32_t row,
                                 const struct hull_contact *impact)
{
    const struct path *path = &input->detect.path[row];
    double hz = 1.0 / world_dt_s(input->detect.world), left = 1.0 - path->since;
    struct rotation_path rotation = body_motion_rotation(input->motion, row);
    struct vec3 spin = left > 0.0
                           ? vec3_scale(rotation_speed(rotation.from, rotation.to, 0.0), hz / left)
                           : (struct vec3){0.0, 0.0, 0.0};
    struct vec3 arm = vec3_sub(impact->point, path_at(path, impact->toi));
    return vec3_add(vec3_scale(path->along, hz), vec3_cross(spin, arm));
}

/* Returns true if the bodies of a contact close too slowly for an impact. */
static bool rests_on(const struct contact_input *input, const struct contact *contact)
{
    struct vec3 velocity = skin_velocity(input, contact->a, &contact->impact);
    if (!(contact->b & PAIR_FIXED))
        velocity = vec3_sub(velocity, skin_velocity(input, contact->b, &contact->impact));
    return vec3_dot(velocity, contact->impact.normal) < CONTACT_IMPACT_MPS;
}

/* Returns the velocity of a row on the map at an arm from its position [m/s]. */
static struct vec3 level_velocity(const struct contact_queue *contacts, uint32_t row, double hz,
                                  double x, double z)
{
    const struct row_pose *pose = &contacts->apart.row[row];
    double spin = pose->spin_y * hz;
    return (struct vec3){pose->body.path.along.x * hz + spin * z, 0.0,
                         pose->body.path.along.z * hz - spin * x};
}

/* Returns true if the bodies of a pair that rest on each other close too slowly for an impact at
 * all of their points. */
static bool still_rests(const struct contact_queue *contacts, const struct contact_input *input,
                        uint32_t index)
{
    const struct pair *pair = &contacts->pair[index];
    const struct rest_span *rest = &contacts->rest[index];
    double hz = 1.0 / world_dt_s(input->detect.world);
    for (uint32_t i = rest->first; i < rest->first + rest->count; i++) {
        const struct rest_point *point = &contacts->rest_point[i];
        struct vec3 slip = level_velocity(contacts, pair->a, hz, point->a_x, point->a_z);
        if (!(pair->b & PAIR_FIXED))
            slip = vec3_sub(slip, level_velocity(contacts, pair->b, hz, point->b_x, point->b_z));
        if (slip.x * point->normal_x + slip.z * point->normal_z >= CONTACT_IMPACT_MPS)
            return false;
    }
    return rest->count > 0;
}

/* Sweeps one pair from a time on. Returns true, with the contact, if there is one. Bodies that rest
 * on each other touch all the time: they are swept only if they may get into each other. */
static bool sweep_pair(struct contact_queue *contacts, const struct contact_input *input,
                       uint32_t index, double from, struct contact *contact)
{
    const struct pair *pair = &contacts->pair[index];
    const uint8_t *state = input->detect.entities->state;
    bool fixed = pair->b & PAIR_FIXED;
    if (contacts->met[index] >= input->meets || state[pair->a] == ENTITY_FREE ||
        (!fixed && state[pair->b] == ENTITY_FREE) ||
        (fixed && !pair_filter_stands(&input->detect, pair->b & ~PAIR_FIXED)))
        return false;
    if (contacts->marks[index] & CONTACT_PARTS ||
        (contacts->proves && still_rests(contacts, input, index)))
        return false;
    if (contacts->proves &&
        pair_apart_stays(&contacts->apart, pair, from, SKIN_M, &contacts->known[index].plane[0]))
        return false;
    *contact = (struct contact){.a = pair->a,
                                .b = pair->b,
                                .pair = index + 1,
                                .version_a = contacts->version[pair->a],
                                .version_b = fixed ? 0 : contacts->version[pair->b]};
    return narrow_phase_find(&input->detect, input->motion, input->through_fixed, pair, from,
                             &contact->impact) &&
           !(contacts->marks[index] & CONTACT_RESTS && rests_on(input, contact));
}

/* Computes what the proofs need of a row, if its path has changed. */
static void prepare(struct contact_queue *contacts, const struct contact_input *input, uint32_t row)
{
    if (contacts->proves && !(row & PAIR_FIXED))
        pair_apart_prepare(&contacts->apart, input->motion, row);
}

struct job {
    struct contact_queue *contacts;
    const struct contact_input *input;
    uint64_t tick;
    _Atomic uint32_t found; /* contacts in the heap's array, unordered */
};

static void note(struct job *job, const struct contact *contact)
{
    struct contact_list *heap = &job->contacts->heap;
    uint32_t place = atomic_fetch_add_explicit(&job->found, 1, memory_order_relaxed);
    CHECK(place < heap->capacity);
    heap->contact[place] = *contact;
}

static void find_some(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct job *job = context;
    struct contact contact;
    (void)worker;
    for (uint32_t i = first; i < end; i++) {
        if (!(job->contacts->marks[i] & CONTACT_RESTS) &&
            sweep_pair(job->contacts, job->input, i, 0.0, &contact))
            note(job, &contact);
        if (i % PAIRS_A_PIECE == 0)
            work_done();
    }
}

/* Adds what the function finds for count things, at most `each` for one of them, to the heap. */
static void find_all(struct job *job, thread_pool_function *find, uint32_t count, uint32_t each,
                     uint32_t grain)
{
    struct contact_queue *contacts = job->contacts;
    make_room(&contacts->heap, count * each);
    job->found = contacts->heap.count;
    thread_pool_run(contacts->workers, find, job, count, grain);
    contacts->heap.count = job->found;
    order_heap(&contacts->heap);
}

void contact_queue_find(struct contact_queue *contacts, const struct contact_input *input)
{
    struct job job = {.contacts = contacts, .input = input};
    for (uint32_t i = 0; i < contacts->pair_count; i++) {
        prepare(contacts, input, contacts->pair[i].a);
        prepare(contacts, input, contacts->pair[i].b);
    }
    find_all(&job, find_some, contacts->pair_count, 1, PAIRS_A_PIECE);
}

static struct contact end_of(const struct contact_queue *contacts, uint32_t row, uint32_t what,
                             double toi)
{
    return (struct contact){
        .impact.toi = toi, .a = row, .b = what, .version_a = contacts->version[row]};
}

void contact_queue_add_end(struct contact_queue *contacts, uint32_t row, uint32_t what, double toi)
{
    const struct contact contact = end_of(contacts, row, what, toi);
    push(contacts, &contact);
}

void contact_queue_ground(struct contact_queue *contacts, const struct contact_input *input,
                          uint32_t row)
{
    const struct entities *e = input->detect.entities;
    double toi;
    bool flies = e->behaviour[row] == BEHAVIOUR_FLIGHT ||
                 input->detect.world->kinds[e->kind[row]].domain == DOMAIN_AIR;
    if (flies && e->state[row] == ENTITY_ACTIVE &&
        ground_impact_row(&input->detect, input->motion, row, &toi))
        contact_queue_add_end(contacts, row, CONTACT_GROUND, toi);
}

static void find_end(struct job *job, uint32_t row)
{
    const struct entities *e = job->input->detect.entities;
    struct contact contact;
    double toi;
    if (ground_impact_row(&job->input->detect, job->input->motion, row, &toi)) {
        contact = end_of(job->contacts, row, CONTACT_GROUND, toi);
        note(job, &contact);
    }
    if (e->behaviour[row] != BEHAVIOUR_FLIGHT || job->tick < e->until_tick[row])
        return;
    contact = end_of(job->contacts, row, CONTACT_AIR, 1.0);
    note(job, &contact);
}

/* Tests fliers first .. end - 1, counted over all sweepers. */
static void find_some_ends(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct job *job = context;
    const struct broad_phase *broad = job->input->broad;
    uint32_t before = 0;
    (void)worker;
    for (uint32_t s = 0; s < broad->sweepers; s++) {
        const struct pair_list *fliers = &broad->sweeper[s].fliers;
        uint32_t i = first > before ? first - before : 0;
        for (; i < fliers->count && before + i < end; i++)
            find_end(job, fliers->pair[i].a);
        before += fliers->count;
    }
}

void contact_queue_find_ends(struct contact_queue *contacts, const struct contact_input *input,
                             uint64_t tick)
{
    struct job job = {.contacts = contacts, .input = input, .tick = tick};
    uint32_t count = 0;
    for (uint32_t i = 0; i < input->broad->sweepers; i++)
        count += input->broad->sweeper[i].fliers.count;
    find_all(&job, find_some_ends, count, ENDS_A_ROW, FLIERS_A_PIECE);
}

const struct contact *contact_queue_peek(struct contact_queue *contacts)
{
    while (contacts->heap.count > 0) {
        const struct contact *first = &contacts->heap.contact[0];
        if (is_valid(contacts, first))
            return first;
        pop(contacts);
    }
    return NULL;
}

bool contact_queue_next(struct contact_queue *contacts, const struct contact_input *input,
                        struct contact *contact)
{
    const struct contact *first = contact_queue_peek(contacts);
    if (!first)
        return false;
    *contact = *first;
    pop(contacts);
    contact->last = contact->pair != 0 && ++contacts->met[contact->pair - 1] >= input->meets;
    return true;
}

void contact_queue_skip_pair(struct contact_queue *contacts, const struct contact *contact)
{
    contacts->swept[contact->pair - 1] = contacts->change + 1;
}

/* --- another way -------------------------------------------------------------------------------*/

/* Returns the index + 1 of a pair, or 0. */
static uint32_t paired(const struct contact_queue *contacts, const struct pair *pair)
{
    for (uint32_t link = contacts->head[pair->a]; link != 0; link = contacts->link[link - 1].next) {
        uint32_t index = contacts->link[link - 1].pair;
        const struct pair *known = &contacts->pair[index];
        if (known->a == pair->a && known->b == pair->b)
            return index + 1;
    }
    return 0;
}

uint32_t contact_queue_pair(struct contact_queue *contacts, const struct pair *pair)
{
    uint32_t known = paired(contacts, pair);
    return known != 0 ? known - 1 : add_pair(contacts, *pair);
}

/* resting: two bodies that rest are a pair, too. */
static void meet(struct contact_queue *contacts, const struct contact_input *input, uint32_t row,
                 uint32_t other, bool resting)
{
    bool fixed = other & PAIR_FIXED;
    struct pair pair = {fixed || row < other ? row : other, fixed || row < other ? other : row};
    if (other == row || paired(contacts, &pair))
        return;
    if (!fixed)
        body_motion_require(input->motion, other);
    if (fixed || (resting ? !pair_same_shooter(input->detect.entities, pair.a, pair.b)
                          : !pair_excluded(&input->detect, pair.a, pair.b)))
        add_pair(contacts, pair);
}

static bool box_within(const struct path_box *inner, const struct path_box *outer)
{
    return inner->min_x >= outer->min_x && inner->max_x <= outer->max_x &&
           inner->min_y >= outer->min_y && inner->max_y <= outer->max_y &&
           inner->min_z >= outer->min_z && inner->max_z <= outer->max_z;
}

static struct path_box box_union(const struct path_box *a, const struct path_box *b)
{
    return (struct path_box){
        a->min_x < b->min_x ? a->min_x : b->min_x, a->min_y < b->min_y ? a->min_y : b->min_y,
        a->min_z < b->min_z ? a->min_z : b->min_z, a->max_x > b->max_x ? a->max_x : b->max_x,
        a->max_y > b->max_y ? a->max_y : b->max_y, a->max_z > b->max_z ? a->max_z : b->max_z,
    };
}

/* Pairs the row with the bodies near its new path: those that the broad phase finds, and the rows
 * that have left their boxes. */
static void look_around(struct contact_queue *contacts, const struct contact_input *input,
                        uint32_t row, bool resting, float wider_m)
{
    struct path_box *known = &input->broad->box[row];
    struct path_box box = pair_filter_box(&input->detect, row);
    box.min_x -= wider_m, box.max_x += wider_m;
    box.min_z -= wider_m, box.max_z += wider_m;
    bool strays = !box_within(&box, known);
    contacts->near.count = 0;
    broad_phase_query(input->broad, &input->detect, &box, &contacts->near);
    uint32_t rows = contacts->near.count;
    broad_phase_query_fixed(input->broad, &input->detect, &box, &contacts->near);
    for (uint32_t i = 0; i < contacts->near.count; i++) {
        const struct pair *near = &contacts->near.pair[i];
        meet(contacts, input, row, i < rows ? near->a : near->b, resting);
    }
    for (uint32_t i = 0; i < contacts->stray_count; i++) {
        if (pair_filter_boxes_meet(&box, &input->broad->box[contacts->strayed[i]]))
            meet(contacts, input, row, contacts->strayed[i], resting);
    }
    if (!strays)
        return;
    if (!contacts->strays[row])
        contacts->strayed[contacts->stray_count++] = row;
    contacts->strays[row] = 1;
    *known = box_union(known, &box);
}

void contact_queue_rest(struct contact_queue *contacts, uint32_t pair,
                        const struct rest_point *point, uint32_t count)
{
    contacts->marks[pair] |= CONTACT_RESTS;
    contacts->rest[pair] = (struct rest_span){contacts->rest_points, 0};
    for (uint32_t i = 0; i < count && contacts->rest_points < contacts->rest_capacity; i++) {
        contacts->rest_point[contacts->rest_points++] = point[i];
        contacts->rest[pair].count++;
    }
    if (contacts->rest[pair].count < count)
        contacts->rest[pair].count = 0;
}

void contact_queue_look(struct contact_queue *contacts, const struct contact_input *input,
                        uint32_t row, bool resting)
{
    if (!method_discrete((enum method)input->detect.world->params->collision.method))
        look_around(contacts, input, row, resting, 0.0f);
}

void contact_queue_look_wider(struct contact_queue *contacts, const struct contact_input *input,
                              uint32_t row, double wider_m)
{
    if (!method_discrete((enum method)input->detect.world->params->collision.method))
        look_around(contacts, input, row, true, (float)wider_m);
}

/* Sweeps the row's pairs, except those that this change has already swept from the other row. */
static void sweep_row(struct contact_queue *contacts, const struct contact_input *input,
                      uint32_t row, double time)
{
    struct contact contact;
    for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
        uint32_t pair = contacts->link[link - 1].pair;
        if (contacts->swept[pair] == contacts->change)
            continue;
        contacts->swept[pair] = contacts->change;
        prepare(contacts, input, contacts->pair[pair].a);
        prepare(contacts, input, contacts->pair[pair].b);
        if (sweep_pair(contacts, input, pair, time, &contact))
            push(contacts, &contact);
    }
    contact_queue_ground(contacts, input, row);
}

void contact_queue_change(struct contact_queue *contacts, const struct contact_input *input,
                          const uint32_t *rows, uint32_t count, double time)
{
    enum method method = (enum method)input->detect.world->params->collision.method;
    contacts->change++;
    for (uint32_t i = 0; i < count; i++) {
        contacts->version[rows[i]]++;
        pair_apart_forget(&contacts->apart, rows[i]);
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!method_discrete(method))
            look_around(contacts, input, rows[i], false, 0.0f);
        sweep_row(contacts, input, rows[i], time);
        work_done();
    }
}

void contact_queue_drop(struct contact_queue *contacts, uint32_t row)
{
    contacts->version[row]++;
    pair_apart_forget(&contacts->apart, row);
}
