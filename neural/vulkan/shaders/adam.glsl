// Adam and the average for a step count.

struct AdamStep {
  float size;
  float epsilon;
  float average_rate;
};

// e^x - 1 for x <= 0.
float exp_less_one(float x) {
  if (x < -0.25) return exp(x) - 1.0;
  return x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * (1.0 / 120.0 + x * (1.0 / 720.0))))));
}

// For t beyond the table: as in adam.h, in single precision.
AdamStep late_adam_step(float t) {
  const float first = -exp_less_one(t * model.adam.log_beta1);
  const float second = sqrt(-exp_less_one(t * model.adam.log_beta2));
  float rate = model.adam.learning_rate;
  if (model.adam.decay_steps > 0.0) rate /= sqrt(1.0 + (t - 1.0) / model.adam.decay_steps);
  const float ramp = 1.0 / (1.0 + (t - 1.0) / model.adam.average_ramp);
  return AdamStep(rate * second / first, model.adam.epsilon * second,
                  max(model.adam.least_average_rate, ramp));
}

AdamStep adam_step(uint t) {
  if (t > model.adam.table_steps) return late_adam_step(float(t));
  const vec4 entry = model.adam_table.at[t];
  return AdamStep(entry.x, entry.y, entry.z);
}

// The factors for the network's t, the number of steps with the current one.
AdamStep adam_step_of_network() {
  const uint low = model.progress.at[0], high = model.progress.at[1];
  if (high == 0u) return adam_step(low);
  return late_adam_step(float(high) * 4294967296.0 + float(low));
}

// Converts gradients of sums to gradients of the mean over accepted records and outputs.
float gradient_scale() {
  return 1.0 / (float(batch.statistics.at[kAccepted]) * float(model.outputs));
}

float moved(float first, float second, AdamStep adam) {
  return adam.size * first / (sqrt(second) + adam.epsilon);
}
