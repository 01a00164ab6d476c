/* The axes of both boxes are tested (Gottschalk, Lin and Manocha 1996). The nine axes across two
 * edges are left out: for bodies that stand upright they show nothing new. */
#include "collider/geometry/box_view.h"

/* Rounding errors of positions and axes, for bodies of up to 100 m [m]. */
#define ROUNDING_M 1e-9

_Static_assert(HULLS_A_MODEL *HULLS_A_MODEL == 64, "one bit for each pair of hulls");

/* A box along some axes. */
struct box {
    double middle[3], half[3]; /* [m] */
};

/* One body's hulls that are near the box around the other body: in its own axes, and as seen in the
 * other's. */
struct box_list {
    struct box own[HULLS_A_MODEL], seen[HULLS_A_MODEL];
    uint32_t hull[HULLS_A_MODEL];
    uint32_t count;
};

/* --- views -------------------------------------------------------------------------------------*/

static struct mat3 turn_between(const struct mat3 *a, const struct mat3 *b)
{
    struct mat3 turn;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            turn.m[i][k] =
                a->m[0][i] * b->m[0][k] + a->m[1][i] * b->m[1][k] + a->m[2][i] * b->m[2][k];
    }
    return turn;
}

static void set_slack(double slack[3], struct vec3 way, double margin_m)
{
    slack[0] = 0.5 * fabs(way.x) + margin_m + ROUNDING_M;
    slack[1] = 0.5 * fabs(way.y) + margin_m + ROUNDING_M;
    slack[2] = 0.5 * fabs(way.z) + margin_m + ROUNDING_M;
}

struct box_view box_view_swept(const struct mat3 *a, const struct mat3 *b, struct vec3 between,
                               struct vec3 way, double margin_m)
{
    struct vec3 middle = vec3_add(between, vec3_scale(way, 0.5));
    struct box_view view = {.turn = turn_between(a, b),
                            .between_a = rotation_back(a, middle),
                            .between_b = rotation_back(b, middle)};
    set_slack(view.slack_a, rotation_back(a, way), margin_m);
    set_slack(view.slack_b, rotation_back(b, way), margin_m);
    return view;
}

struct box_view box_view_of(const struct mat3 *a, const struct mat3 *b, struct vec3 between,
                            double margin_m)
{
    return box_view_swept(a, b, between, (struct vec3){0.0, 0.0, 0.0}, margin_m);
}

/* --- boxes -------------------------------------------------------------------------------------*/

static struct box scaled(struct vec3 middle, struct vec3 half, double s)
{
    return (struct box){{middle.x * s, middle.y * s, middle.z * s},
                        {half.x * s, half.y * s, half.z * s}};
}

static struct box turned_box_of(const struct swept_body *body, const struct hull *hull)
{
    const struct hull_box box = turret_path_box(&body->turret, hull);
    return scaled(box.middle, box.half, body->scale);
}

/* The hull of a turret or a gun is in its box all the frame. */
static struct box box_of(const struct swept_body *body, const struct hull *hull)
{
    return turret_path_turns(&body->turret, hull) ? turned_box_of(body, hull)
                                                  : scaled(hull->centre, hull->half, body->scale);
}

/* Returns the box around the boxes of all hulls, of a body that has no outer hull. */
static struct box around_all(const struct swept_body *body)
{
    struct box all;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; i < body->hull_count; i++) {
            struct box box = box_of(body, &body->hull[i]);
            low = maths_min(low, box.middle[k] - box.half[k]);
            high = maths_max(high, box.middle[k] + box.half[k]);
        }
        all.middle[k] = 0.5 * (low + high);
        all.half[k] = 0.5 * (high - low);
    }
    return all;
}

/* Returns the box around all hulls of the body. */
static struct box outer_box_of(const struct swept_body *body)
{
    if (body->turret.outers == 0)
        return body->outer ? box_of(body, body->outer) : around_all(body);
    const struct hull_box box = turret_path_box_all(&body->turret);
    return scaled(box.middle, box.half, body->scale);
}

/* Returns the box of b in a's axes. */
static struct box seen_by_a(const struct box_view *view, const struct box *own)
{
    const double(*m)[3] = view->turn.m, *p = own->middle, *h = own->half;
    const double at[3] = {view->between_a.x, view->between_a.y, view->between_a.z};
    struct box box;
    for (int k = 0; k < 3; k++) {
        box.middle[k] = at[k] + (m[k][0] * p[0] + m[k][1] * p[1] + m[k][2] * p[2]);
        box.half[k] = fabs(m[k][0]) * h[0] + fabs(m[k][1]) * h[1] + fabs(m[k][2]) * h[2];
    }
    return box;
}

/* Returns the box of a in b's axes. */
static struct box seen_by_b(const struct box_view *view, const struct box *own)
{
    const double(*m)[3] = view->turn.m, *p = own->middle, *h = own->half;
    const double at[3] = {view->between_b.x, view->between_b.y, view->between_b.z};
    struct box box;
    for (int k = 0; k < 3; k++) {
        box.middle[k] = m[0][k] * p[0] + m[1][k] * p[1] + m[2][k] * p[2] - at[k];
        box.half[k] = fabs(m[0][k]) * h[0] + fabs(m[1][k]) * h[1] + fabs(m[2][k]) * h[2];
    }
    return box;
}

static bool apart(const struct box *p, const struct box *q, const double slack[3])
{
    for (int k = 0; k < 3; k++) {
        if (fabs(p->middle[k] - q->middle[k]) > p->half[k] + q->half[k] + slack[k])
            return true;
    }
    return false;
}

/* Returns true if a box of a and a box of b are certainly not near. */
static bool both_apart(const struct box_view *view, const struct box *box_a,
                       const struct box *box_b)
{
    struct box seen = seen_by_a(view, box_b);
    if (apart(box_a, &seen, view->slack_a))
        return true;
    seen = seen_by_b(view, box_a);
    return apart(box_b, &seen, view->slack_b);
}

/* Keeps a hull if the box around the other body is near it, by the axes of its own body and by
 * those of the other. */
static void keep_near(struct box_list *list, uint32_t hull, const struct box *own,
                      const struct box *seen, bool near)
{
    list->own[list->count] = *own;
    list->seen[list->count] = *seen;
    list->hull[list->count] = hull;
    list->count += near;
}

/* How one body sees the other. */
struct looking {
    const struct swept_body *body;
    const struct box *outer, *outer_seen; /* around the other body, in its axes and in the body's */
    struct box (*seen)(const struct box_view *view, const struct box *own); /* by the other body */
    const double *slack, *slack_seen; /* of the body's axes and of the other's */
};

/* Lists the hulls of a body that are near the box around the other one. */
static void list_near(const struct box_view *view, const struct looking *looking,
                      struct box_list *list)
{
    list->count = 0;
    for (uint32_t i = 0; i < looking->body->hull_count; i++) {
        struct box own = box_of(looking->body, &looking->body->hull[i]);
        if (apart(&own, looking->outer_seen, looking->slack))
            continue;
        struct box seen = looking->seen(view, &own);
        keep_near(list, i, &own, &seen, !apart(looking->outer, &seen, looking->slack_seen));
    }
}

/* --- public ------------------------------------------------------------------------------------*/

bool box_view_apart(const struct box_view *view, const struct swept_body *a,
                    const struct hull *hull_a, const struct swept_body *b,
                    const struct hull *hull_b)
{
    struct box box_a = box_of(a, hull_a), box_b = box_of(b, hull_b);
    return both_apart(view, &box_a, &box_b);
}

uint64_t box_view_near(const struct box_view *view, const struct swept_body *a,
                       const struct swept_body *b)
{
    struct box_list list_a, list_b;
    uint64_t near = 0;
    struct box outer_a = outer_box_of(a), outer_b = outer_box_of(b);
    struct box seen_a = seen_by_b(view, &outer_a), seen_b = seen_by_a(view, &outer_b);
    if (apart(&outer_a, &seen_b, view->slack_a) || apart(&outer_b, &seen_a, view->slack_b))
        return 0;
    list_near(view,
              &(struct looking){a, &outer_b, &seen_b, seen_by_b, view->slack_a, view->slack_b},
              &list_a);
    if (list_a.count == 0)
        return 0;
    list_near(view,
              &(struct looking){b, &outer_a, &seen_a, seen_by_a, view->slack_b, view->slack_a},
              &list_b);
    for (uint32_t i = 0; i < list_a.count; i++) {
        for (uint32_t j = 0; j < list_b.count; j++) {
            if (!apart(&list_a.own[i], &list_b.seen[j], view->slack_a) &&
                !apart(&list_b.own[j], &list_a.seen[i], view->slack_b))
                near |= 1ull << (HULLS_A_MODEL * list_a.hull[i] + list_b.hull[j]);
        }
    }
    return near;
}
