/* The verb make. */
#ifndef JOLON_SUPERVISOR_GROUND_MAKE_H
#define JOLON_SUPERVISOR_GROUND_MAKE_H

int make_run(int argc, char **argv);

#endif
