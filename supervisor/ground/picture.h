/* The verbs show and export. */
#ifndef JOLON_SUPERVISOR_GROUND_PICTURE_H
#define JOLON_SUPERVISOR_GROUND_PICTURE_H

int picture_show(int argc, char **argv);
int picture_export(int argc, char **argv);

#endif
