/* Transverse Mercator by Krueger's series. */
#include "world/terrain/projection.h"

#include "world/maths/maths.h"

#define EQUATOR_M     6378137.0
#define FLATTENING    (1.0 / 298.257223563)
#define N             (FLATTENING / (2.0 - FLATTENING)) /* the third flattening */
#define MEAN_RADIUS_M 6371008.8

/* Length of a radian of the rectifying latitude. */
#define RECTIFYING_M                                                                               \
    (EQUATOR_M / (1.0 + N) * (1.0 + N * N * (1.0 / 4.0 + N * N * (1.0 / 64.0 + N * N / 256.0))))

#define TERMS 6

/* Coefficients of sines of twice, four times ... the angle: from the geographic latitude to the
 * conformal one and back, and from the sphere's transverse Mercator to the ellipsoid's and back. */
static const double to_conformal[TERMS] = {
    N * (-2.0 +
         N * (2.0 / 3.0 +
              N * (4.0 / 3.0 + N * (-82.0 / 45.0 + N * (32.0 / 45.0 + N * (4642.0 / 4725.0)))))),
    N *N *(5.0 / 3.0 +
           N * (-16.0 / 15.0 + N * (-13.0 / 9.0 + N * (904.0 / 315.0 + N * (-1522.0 / 945.0))))),
    N *N *N *(-26.0 / 15.0 + N * (34.0 / 21.0 + N * (8.0 / 5.0 + N * (-12686.0 / 2835.0)))),
    N *N *N *N *(1237.0 / 630.0 + N * (-12.0 / 5.0 + N * (-24832.0 / 14175.0))),
    N *N *N *N *N *(-734.0 / 315.0 + N * (109598.0 / 31185.0)),
    N *N *N *N *N *N *(444337.0 / 155925.0)};
static const double from_conformal[TERMS] = {
    N * (2.0 + N * (-2.0 / 3.0 +
                    N * (-2.0 + N * (116.0 / 45.0 + N * (26.0 / 45.0 + N * (-2854.0 / 675.0)))))),
    N *N *(7.0 / 3.0 +
           N * (-8.0 / 5.0 + N * (-227.0 / 45.0 + N * (2704.0 / 315.0 + N * (2323.0 / 945.0))))),
    N *N *N *(56.0 / 15.0 + N * (-136.0 / 35.0 + N * (-1262.0 / 105.0 + N * (73814.0 / 2835.0)))),
    N *N *N *N *(4279.0 / 630.0 + N * (-332.0 / 35.0 + N * (-399572.0 / 14175.0))),
    N *N *N *N *N *(4174.0 / 315.0 + N * (-144838.0 / 6237.0)),
    N *N *N *N *N *N *(601676.0 / 22275.0)};
static const double to_ellipsoid[TERMS] = {
    N * (0.5 +
         N * (-2.0 / 3.0 + N * (5.0 / 16.0 + N * (41.0 / 180.0 +
                                                  N * (-127.0 / 288.0 + N * (7891.0 / 37800.0)))))),
    N *N *(13.0 / 48.0 +
           N * (-3.0 / 5.0 +
                N * (557.0 / 1440.0 + N * (281.0 / 630.0 + N * (-1983433.0 / 1935360.0))))),
    N *N *N *(61.0 / 240.0 +
              N * (-103.0 / 140.0 + N * (15061.0 / 26880.0 + N * (167603.0 / 181440.0)))),
    N *N *N *N *(49561.0 / 161280.0 + N * (-179.0 / 168.0 + N * (6601661.0 / 7257600.0))),
    N *N *N *N *N *(34729.0 / 80640.0 + N * (-3418889.0 / 1995840.0)),
    N *N *N *N *N *N *(212378941.0 / 319334400.0)};
static const double to_sphere[TERMS] = {
    N * (-0.5 + N * (2.0 / 3.0 +
                     N * (-37.0 / 96.0 +
                          N * (1.0 / 360.0 + N * (81.0 / 512.0 + N * (-96199.0 / 604800.0)))))),
    N *N *(-1.0 / 48.0 +
           N * (-1.0 / 15.0 +
                N * (437.0 / 1440.0 + N * (-46.0 / 105.0 + N * (1118711.0 / 3870720.0))))),
    N *N *N *(-17.0 / 480.0 + N * (37.0 / 840.0 + N * (209.0 / 4480.0 + N * (-5569.0 / 90720.0)))),
    N *N *N *N *(-4397.0 / 161280.0 + N * (11.0 / 504.0 + N * (830251.0 / 7257600.0))),
    N *N *N *N *N *(-4583.0 / 161280.0 + N * (108847.0 / 3991680.0)),
    N *N *N *N *N *N *(-20648693.0 / 638668800.0)};

/* The sine and cosine of an angle with an imaginary part: those of the angle, and the hyperbolic
 * ones of the imaginary part. */
struct double_angle {
    double sine, cosine, sinh, cosh;
};

/* Adds the sum of coefficient j times the sine of 2 j times the complex angle to (real, imaginary),
 * by Clenshaw's recurrence. twice: of twice the angle. */
static void add_sines(const double coefficient[TERMS], struct double_angle twice, double *real,
                      double *imaginary)
{
    double factor_r = 2.0 * twice.cosine * twice.cosh, factor_i = -2.0 * twice.sine * twice.sinh;
    double r1 = 0.0, i1 = 0.0, r2 = 0.0, i2 = 0.0;
    for (int j = TERMS - 1; j >= 0; j--) {
        double r = coefficient[j] + factor_r * r1 - factor_i * i1 - r2;
        double i = factor_r * i1 + factor_i * r1 - i2;
        r2 = r1;
        i2 = i1;
        r1 = r;
        i1 = i;
    }
    double sine_r = twice.sine * twice.cosh, sine_i = twice.cosine * twice.sinh;
    *real += sine_r * r1 - sine_i * i1;
    *imaginary += sine_r * i1 + sine_i * r1;
}

static double latitude_by(const double coefficient[TERMS], double latitude)
{
    double none = 0.0;
    struct double_angle twice = {.cosh = 1.0};
    maths_sincos(2.0 * latitude, &twice.sine, &twice.cosine);
    add_sines(coefficient, twice, &latitude, &none);
    return latitude;
}

/* Inverse hyperbolic tangent of |v| <= 0.2, and hyperbolic sine of |v| <= 0.5: power series up to
 * the last bit. */
static double small_atanh(double v)
{
    double square = v * v, sum = 0.0;
    for (int n = 23; n >= 1; n -= 2)
        sum = sum * square + 1.0 / n;
    return sum * v;
}

static double small_sinh(double v)
{
    double square = v * v, sum = 1.0;
    for (int n = 16; n >= 2; n -= 2)
        sum = 1.0 + sum * square / (double)(n * (n + 1));
    return sum * v;
}

/* A place [rad, longitude from the middle] to rectified coordinates [rad]. */
static void forward(double latitude, double longitude, double *north, double *east)
{
    double sine, cosine, sine_east, cosine_east;
    maths_sincos(latitude_by(to_conformal, latitude), &sine, &cosine);
    maths_sincos(longitude, &sine_east, &cosine_east);
    double tanh_east = cosine * sine_east;
    *north = maths_atan2(sine, cosine * cosine_east);
    *east = small_atanh(maths_clamp(tanh_east, -0.2, 0.2));
    struct double_angle twice = {.sinh = 2.0 * tanh_east / (1.0 - tanh_east * tanh_east),
                                 .cosh =
                                     (1.0 + tanh_east * tanh_east) / (1.0 - tanh_east * tanh_east)};
    maths_sincos(2.0 * *north, &twice.sine, &twice.cosine);
    add_sines(to_ellipsoid, twice, north, east);
}

void projection_make(struct projection *projection, double latitude_deg, double longitude_deg,
                     double side_m)
{
    double north, east;
    forward(latitude_deg * RAD_PER_DEG, 0.0, &north, &east);
    *projection = (struct projection){.longitude_rad = longitude_deg * RAD_PER_DEG,
                                      .north_m = RECTIFYING_M * north,
                                      .middle_m = 0.5 * side_m};
}

void projection_world(const struct projection *projection, double latitude_deg,
                      double longitude_deg, double *x, double *z)
{
    double north, east;
    double longitude = maths_wrap_half(longitude_deg * RAD_PER_DEG - projection->longitude_rad);
    forward(latitude_deg * RAD_PER_DEG, longitude, &north, &east);
    *x = projection->middle_m + RECTIFYING_M * east;
    *z = projection->middle_m - (RECTIFYING_M * north - projection->north_m);
}

void projection_place(const struct projection *projection, double x, double z, double *latitude_deg,
                      double *longitude_deg)
{
    double east = (x - projection->middle_m) / RECTIFYING_M;
    double north = (projection->north_m + projection->middle_m - z) / RECTIFYING_M;
    struct double_angle twice = {.sinh = small_sinh(2.0 * maths_clamp(east, -0.25, 0.25))};
    twice.cosh = sqrt(1.0 + twice.sinh * twice.sinh);
    maths_sincos(2.0 * north, &twice.sine, &twice.cosine);
    add_sines(to_sphere, twice, &north, &east);
    double sine, cosine, sinh_east = small_sinh(maths_clamp(east, -0.5, 0.5));
    maths_sincos(north, &sine, &cosine);
    double conformal = maths_atan2(sine, sqrt(sinh_east * sinh_east + cosine * cosine));
    double longitude = projection->longitude_rad + maths_atan2(sinh_east, cosine);
    *latitude_deg = latitude_by(from_conformal, conformal) * DEG_PER_RAD;
    *longitude_deg = maths_wrap_half(longitude) * DEG_PER_RAD;
}

double projection_stretch(double distance_m)
{
    double share = distance_m / MEAN_RADIUS_M;
    return 0.5 * share * share;
}
