#include "backlash.h"
#include "bias.h"
#include "delay.h"
#include "dropout.h"
#include "gain.h"
#include "jitter.h"
#include "quantization.h"
#include "random_walk.h"
#include "saturation.h"
#include "spark/plugin.h"
#include "white_noise.h"

SPARK_PLUGIN("modifiers", "1.0", "Models of imperfect sensors and effectors: noise, delay, loss, backlash.",
             spark::Bias, spark::WhiteNoise, spark::RandomWalk, spark::Quantization, spark::Saturation, spark::Gain,
             spark::Backlash, spark::Delay, spark::Jitter, spark::Dropout)
