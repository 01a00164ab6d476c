/* Places of a shell's points, and its contacts with the ground. */
#include "mover/motion/body_shell.h"

#include "world/entity/kind.h"

#define UNDERSIDE   0.35 /* half length of the underside over the length */
#define NOSE_HEIGHT 0.45 /* of the ends over the height */
#define HARD_MPS    2.0  /* a shell that is hit more slowly takes no harm */

void body_shell_of(const struct kind *kind, struct body_shell *shell)
{
    for (unsigned n = 0; n < BODY_SHELL_POINTS; n++) {
        unsigned layer = n / 4;
        double length = kind->length_m * (layer == 0 ? UNDERSIDE : 0.5);
        double height = layer == 0   ? kind->travel_m
                        : layer == 1 ? maths_max(NOSE_HEIGHT * kind->height_m, kind->travel_m)
                                     : kind->height_m;
        shell->point[n] = (struct vec3){n & 1 ? length : -length, height,
                                        n & 2 ? 0.5 * kind->width_m : -0.5 * kind->width_m};
    }
    double wide = 0.25 * (kind->length_m * kind->length_m + kind->width_m * kind->width_m);
    shell->reach_m = sqrt(wide + kind->height_m * kind->height_m);
}

/* Returns the greatest speed at which a contact's point came down on the ground. */
static double fastest(const struct ground_contacts *contacts)
{
    double most = 0.0;
    for (uint32_t i = 0; i < contacts->count; i++) {
        if (contacts->contact[i].impulse_ns[CONTACT_NORMAL] > 0.0)
            most = maths_max(most, contacts->contact[i].closing_mps);
    }
    return most;
}

struct body_shell_push body_shell_touch(const struct body_shell *shell,
                                        const struct step_context *context, const struct kind *kind,
                                        struct rigid_body *body, double dt_s)
{
    const struct body_points points = {
        .point = shell->point, .count = BODY_SHELL_POINTS, .reach_m = shell->reach_m};
    struct body_shell_push push = {0};
    struct ground_contacts contacts;
    ground_contacts_begin(&contacts, kind);
    ground_contacts_find(&contacts, context, &points, body, dt_s);
    push.impulse_ns = ground_contacts_solve(&contacts, body, dt_s);
    if (push.impulse_ns <= 0.0)
        return push;
    if (fastest(&contacts) > HARD_MPS)
        push.hard_j = maths_max(0.0, ground_contacts_taken(&contacts, body));
    ground_contacts_push(&contacts, body, dt_s, &push.velocity_mps, &push.spin_rps);
    return push;
}
