/* An entity of a batch as a JSON object. */
#include "ipc/topics/entity_json.h"

#include "ipc/topics/json_members.h"
#include "world/entity/entity.h"
#include "world/enum_names.h"
#include "world/maths/maths.h"

cJSON *entity_json(const struct world_mirror *mirror, const jolon_Entity *entity)
{
    const double place[3] = {entity->x_m, entity->y_m, entity->z_m};
    const float velocity[3] = {entity->vx_mps, entity->vy_mps, entity->vz_mps};
    cJSON *object = cJSON_CreateObject();
    put_whole(object, "id", entity->id);
    if (name_table_of(&mirror->names, entity->id)[0])
        put_word(object, "name", name_table_of(&mirror->names, entity->id));
    put_word(object, "kind", world_mirror_kind_name(mirror, entity->kind));
    put_word(object, "force", force_name((enum force)entity->force));
    (void)cJSON_AddItemToObject(object, "position", cJSON_CreateDoubleArray(place, 3));
    (void)cJSON_AddItemToObject(object, "velocity", cJSON_CreateFloatArray(velocity, 3));
    put_number(object, "heading_deg", (double)entity->heading_rad * DEG_PER_RAD);
    put_number(object, "pitch_deg", (double)entity->pitch_rad * DEG_PER_RAD);
    put_number(object, "roll_deg", (double)entity->roll_rad * DEG_PER_RAD);
    put_number(object, "turret_deg", (double)entity->turret_rad * DEG_PER_RAD);
    put_number(object, "gun_deg", (double)entity->gun_rad * DEG_PER_RAD);
    put_word(object, "state", entity_state_name((enum entity_state)entity->state));
    put_word(object, "damage", damage_name((enum damage)entity->damage));
    put_word(object, "behaviour", behaviour_name((enum behaviour)entity->behaviour));
    put_whole(object, "target", entity->target);
    put_whole(object, "rounds", entity->rounds);
    put_single(object, "fuel", entity->fuel_l);
    put_single(object, "reload_s", entity->reload_s);
    put_single(object, "throttle", entity->throttle);
    put_word(object, "gear", gear_name((enum gearing)entity->gear));
    (void)cJSON_AddBoolToObject(object, "driven", entity->driver != 0);
    return object;
}
