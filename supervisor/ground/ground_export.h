/* The verb export. Main thread only. */
#ifndef JOLON_SUPERVISOR_GROUND_GROUND_EXPORT_H
#define JOLON_SUPERVISOR_GROUND_GROUND_EXPORT_H

int ground_export_run(int argc, char **argv);

#endif
