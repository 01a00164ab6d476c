/* Follows a vehicle and fires at every vehicle that fires at it. It needs only Cyclone DDS and
 * ipc/topics/status.idl. usage: escort WORLD OWN-ID FRIEND-ID     (see docs/examples/README.md) */
#include "status.h"
#include <dds/dds.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static dds_entity_t participant, subscriber, publisher;
static jolon_Command drive = {.type = jolon_COMMAND_DRIVE}, fire = {.type = jolon_COMMAND_FIRE};

static dds_entity_t make_endpoint(const char *name, const dds_topic_descriptor_t *type, bool writer)
{
    dds_qos_t *qos = dds_create_qos();
    dds_entity_t topic = dds_create_topic(participant, type, name, NULL, NULL);
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(10));
    dds_qset_durability(qos, writer ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1024);
    return writer ? dds_create_writer(publisher, topic, qos, NULL)
                  : dds_create_reader(subscriber, topic, qos, NULL);
}

static jolon_Degrees place; /* of the own vehicle on the earth */

/* Steers to the place 40 m behind the friend, the faster the farther it is. */
static void steer(const jolon_EntityBatch *batch, uint32_t friend_id)
{
    const jolon_Entity *own = NULL, *friend = NULL, *all = batch->entities._buffer;
    for (uint32_t i = 0; i < batch->entities._length; i++) {
        own = all[i].id == drive.entity ? &all[i] : own;
        friend = all[i].id == friend_id ? &all[i] : friend;
    }
    if (!own || !friend)
        return;
    if (batch->places._length == batch->entities._length)
        place = batch->places._buffer[own - all];
    double x = friend->x_m - 40.0 * sin(friend->heading_rad) - own->x_m;
    double z = friend->z_m + 40.0 * cos(friend->heading_rad) - own->z_m;
    double turn = remainder(atan2(x, -z) - own->heading_rad, 2.0 * M_PI), away = hypot(x, z);
    drive.brake = away < 15.0 ? 1.0F : 0.0F;
    drive.throttle = away < 15.0 ? 0.0F : (float)fmin(1.0, away / 60.0);
    drive.steer = away < 15.0 ? 0.0F : (float)fmax(-1.0, fmin(1.0, 2.0 * turn));
}

/* The command is sent again under its number until it is answered, and takes effect once. */
static void order_fire(uint32_t at)
{
    fire.target = at, fire.sequence = ++drive.sequence;
}

/* Orders a shot back. A restarted reporter sends events again, so known ones are skipped. */
static void on_shot(const jolon_FireEvent *shot, uint32_t friend_id)
{
    static uint64_t last;
    if (shot->header.sequence > last && shot->target.id == friend_id && !fire.target) {
        printf("%u fires from %s\n", shot->shooter.id, shot->mgrs);
        order_fire(shot->shooter.id);
    }
    last = shot->header.sequence > last ? shot->header.sequence : last;
}

static void on_reply(const jolon_CommandReply *reply)
{
    if (!fire.target || reply->source != fire.source || reply->sequence != fire.sequence)
        return;
    if (reply->result == jolon_RESULT_DONE)
        printf("shot at %u in frame %llu from %.5f, %.5f\n", fire.target,
               (unsigned long long)reply->frame, place.latitude_deg, place.longitude_deg);
    if (reply->result == jolon_RESULT_CANNOT)
        order_fire(fire.target); /* the gun is not laid on the target yet: try again */
    else
        fire.target = 0;
}

int main(int argc, char **argv)
{
    if (argc != 4)
        return 2;
    void *sample = NULL;
    dds_sample_info_t info;
    setbuf(stdout, NULL);
    uint32_t friend_id = (uint32_t)atoi(argv[3]);
    dds_qos_t *qos = dds_create_qos();
    dds_qset_partition1(qos, argv[1]); /* the world's name */
    participant = dds_create_participant(0, NULL, NULL);
    subscriber = dds_create_subscriber(participant, qos, NULL);
    publisher = dds_create_publisher(participant, qos, NULL);
    dds_entity_t batches = make_endpoint("EntityBatch", &jolon_EntityBatch_desc, false);
    dds_entity_t shots = make_endpoint("FireEvent", &jolon_FireEvent_desc, false);
    dds_entity_t replies = make_endpoint("CommandReply", &jolon_CommandReply_desc, false);
    dds_entity_t commands = make_endpoint("Command", &jolon_Command_desc, true);
    drive.entity = fire.entity = (uint32_t)atoi(argv[2]);
    drive.source = fire.source = (uint64_t)dds_time() ^ (uint64_t)getpid() << 40;
    drive.lease_frames = 90; /* 1.5 s, renewed below; after that its agent drives it */
    for (;; usleep(100000), drive.sequence++, dds_write(commands, &drive)) {
        for (; dds_take(batches, &sample, &info, 1, 1) > 0; dds_return_loan(batches, &sample, 1))
            steer(sample, friend_id);
        for (; dds_take(shots, &sample, &info, 1, 1) > 0; dds_return_loan(shots, &sample, 1))
            on_shot(sample, friend_id);
        for (; dds_take(replies, &sample, &info, 1, 1) > 0; dds_return_loan(replies, &sample, 1))
            on_reply(sample);
        if (fire.target)
            dds_write(commands, &fire);
    }
}
