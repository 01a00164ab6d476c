/* A binary heap, earliest first. Void contacts stay until they come to the top or are half of all.
 */
#include "collider/narrow_phase/contact_heap.h"

#include "world/params.h"
#include "world/runtime/check.h"
#include "world/runtime/reserve.h"

/* Most contacts in the queue: one of each pair, two ends of each row, and as many void ones. */
#define HEAP_MAX (2u * (PAIRS_MAX + CONTACT_HEAP_ENDS * CAPACITY_MAX))

uint32_t contact_heap_most(const struct contact_queue *contacts, uint32_t pairs)
{
    return pairs + CONTACT_HEAP_ENDS * contacts->rows;
}

/* A total order of contacts, independent of the order in which they were found. */
static bool earlier(const struct contact *p, const struct contact *q)
{
    if (p->impact.toi != q->impact.toi)
        return p->impact.toi < q->impact.toi;
    if (p->a != q->a)
        return p->a < q->a;
    return p->b < q->b;
}

bool contact_heap_is_valid(const struct contact_queue *contacts, const struct contact *contact)
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

void contact_heap_order(struct contact_list *heap)
{
    for (uint32_t i = heap->count / 2; i > 0; i--)
        sift_down(heap->contact, heap->count, i - 1, heap->contact[i - 1]);
}

static void drop_void(struct contact_queue *contacts)
{
    struct contact_list *heap = &contacts->heap;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < heap->count; i++) {
        if (contact_heap_is_valid(contacts, &heap->contact[i]))
            heap->contact[kept++] = heap->contact[i];
    }
    heap->count = kept;
    contact_heap_order(heap);
}

void contact_heap_make_room(struct contact_list *heap, uint32_t more)
{
    uint64_t needed = (uint64_t)heap->count + more;
    if (needed <= heap->capacity)
        return;
    CHECK(needed <= HEAP_MAX);
    heap->contact = reserve_grow(heap->contact, heap->count, 2 * needed, sizeof *heap->contact);
    heap->capacity = (uint32_t)(2 * needed);
}

void contact_heap_push(struct contact_queue *contacts, const struct contact *contact)
{
    if (contacts->heap.count >= 2 * contact_heap_most(contacts, contacts->pair_count))
        drop_void(contacts);
    contact_heap_make_room(&contacts->heap, 1);
    struct contact *heap = contacts->heap.contact;
    uint32_t i = contacts->heap.count++;
    while (i > 0 && earlier(contact, &heap[(i - 1) / 2])) {
        heap[i] = heap[(i - 1) / 2];
        i = (i - 1) / 2;
    }
    heap[i] = *contact;
}

void contact_heap_pop(struct contact_queue *contacts)
{
    struct contact_list *heap = &contacts->heap;
    heap->count--;
    sift_down(heap->contact, heap->count, 0, heap->contact[heap->count]);
}
