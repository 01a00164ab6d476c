/* An entity of a batch as a JSON object. */
#include "ipc/topics/entity_json.h"

#include "ipc/json/world_json.h"
#include "world/entity/entity.h"
#include "world/enum_names.h"
#include "world/maths/maths.h"

cJSON *entity_json(const struct world_mirror *mirror, const jolon_Entity *entity)
{
    const float velocity[3] = {entity->vx_mps, entity->vy_mps, entity->vz_mps};
    cJSON *object = cJSON_CreateObject();
    json_whole(object, "id", entity->id);
    if (name_table_of(&mirror->names, entity->id)[0])
        json_text(object, "name", name_table_of(&mirror->names, entity->id));
    json_text(object, "kind", world_mirror_kind_name(mirror, entity->kind));
    json_text(object, "force", force_name((enum force)entity->force));
    json_triple(object, "position", entity->x_m, entity->y_m, entity->z_m);
    (void)cJSON_AddItemToObject(object, "velocity", cJSON_CreateFloatArray(velocity, 3));
    json_number(object, "heading_deg", (double)entity->heading_rad * DEG_PER_RAD);
    json_number(object, "pitch_deg", (double)entity->pitch_rad * DEG_PER_RAD);
    json_number(object, "roll_deg", (double)entity->roll_rad * DEG_PER_RAD);
    json_number(object, "turret_deg", (double)entity->turret_rad * DEG_PER_RAD);
    json_number(object, "gun_deg", (double)entity->gun_rad * DEG_PER_RAD);
    json_text(object, "state", entity_state_name((enum entity_state)entity->state));
    json_text(object, "damage", damage_name((enum damage)entity->damage));
    json_text(object, "behaviour", behaviour_name((enum behaviour)entity->behaviour));
    json_whole(object, "target", entity->target);
    json_whole(object, "rounds", entity->rounds);
    json_single(object, "fuel", entity->fuel_l);
    json_single(object, "reload_s", entity->reload_s);
    json_single(object, "throttle", entity->throttle);
    json_single(object, "spool", entity->spool);
    json_bool(object, "grounded", entity->grounded);
    json_bool(object, "pull_up", entity->pull_up);
    json_text(object, "gear", gear_name((enum gearing)entity->gear));
    json_bool(object, "driven", entity->driver != 0);
    return object;
}
