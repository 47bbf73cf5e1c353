/**
 * @file material.hpp
 * C++17: constitutive laws, built in or the host's. See mpm.hpp.
 */
#ifndef MPM_MATERIAL_HPP
#define MPM_MATERIAL_HPP

#include <mpm/context.hpp>
#include <mpm/material.h>

namespace mpm {

/** A law of the host: what mpm_material_desc has, with function objects (mt). */
struct law {
  double density = 0.0;                        /**< mass per initial volume, > 0; the host must set it */
  int32_t state_count = 0;                     /**< number of state variables of a particle */
  std::vector<double> state_initial;           /**< [state_count] state of a new particle; empty: zeros */
  callback<const mpm_material_batch &> stress; /**< the law: see mpm_stress_fn; the host must set it */
  /** The tangent: see mpm_tangent_fn. Takes the batch of the law, the tangent to be written, and a flag for
   * major symmetry, which starts as false. Empty: stresses are differenced. */
  callback<const mpm_material_batch &, double *, bool &> tangent;
  int32_t tangent_form = MPM_TANGENT_MINOR_SYMMETRIC; /**< form in which the tangent is written */
};

/** What mpm_material_model_param() tells of a parameter of a built-in law. */
struct parameter {
  std::string name;     /**< name, as mpm_param has it */
  std::string unit;     /**< unit as a dimension, such as "stress" */
  std::string text;     /**< one line on its meaning */
  double value_default; /**< default; NaN: it must be given */
  double low;           /**< least value */
  double high;          /**< largest value */
};

namespace detail {

/** The material of C with its context and, for a law of the host, the functions. */
struct material_core {
  std::shared_ptr<context_core> context; /**< outlives the material */
  mpm_material *handle = nullptr;        /**< what mpm_material_create() gave */
  law functions;                         /**< what the library calls while the material lives */

  explicit material_core(std::shared_ptr<context_core> made_with, law host = {})
      : context(std::move(made_with)), functions(std::move(host)) {}
  material_core(const material_core &) = delete;
  material_core &operator=(const material_core &) = delete;
  ~material_core() {
    context->leave([held = handle] { return mpm_material_destroy(held) == MPM_OK; });
  }

  /** The law as C calls it; user is a material_core. */
  static mpm_status stress(void *user, const mpm_material_batch *batch) {
    auto &self = *static_cast<material_core *>(user);
    return guarded(self.context->exceptions, self.functions.stress, *batch);
  }
  /** The tangent as C calls it. */
  static mpm_status tangent(void *user, const mpm_material_batch *batch, double *out, int32_t *symmetric) {
    auto &self = *static_cast<material_core *>(user);
    bool is_symmetric = false;
    const mpm_status status =
        guarded(self.context->exceptions, self.functions.tangent, *batch, out, is_symmetric);
    *symmetric = is_symmetric;
    return status;
  }
};

} // namespace detail

/** A material: see material.h. Sets of it keep it alive. */
class material : public wrapper<detail::material_core> {
public:
  /** Makes a material from a built-in law, with parameters such as {{"E", 1e6}, {"nu", 0.3}, {"density",
   * 1e3}}: see mpm_material_create(). */
  material(const context &made_with, const std::string &model, span<const mpm_param> parameters)
      : wrapper(made_with.shared()) {
    detail::material_core &c = core();
    c.context->check(mpm_material_create(c.context->handle, model.c_str(), parameters.data(),
                                         static_cast<int32_t>(parameters.size()), &c.handle));
  }
  /** Makes a material from a law of the host: see mpm_material_create_custom(). */
  material(const context &made_with, law host) : wrapper(made_with.shared(), std::move(host)) {
    detail::material_core &c = core();
    const law &given = c.functions;
    if (!given.state_initial.empty())
      detail::expect_size("state_initial", given.state_initial.size(), given.state_count);
    mpm_material_desc desc{};
    c.context->check(mpm_material_desc_init(&desc, sizeof desc));
    desc.state_count = given.state_count;
    desc.tangent_form = given.tangent_form;
    desc.density = given.density;
    if (given.stress) desc.stress = detail::material_core::stress;
    if (given.tangent) desc.tangent = detail::material_core::tangent;
    desc.user = &c;
    if (!given.state_initial.empty()) desc.state_initial = given.state_initial.data();
    c.context->check(mpm_material_create_custom(c.context->handle, &desc, &c.handle));
  }
  /** Makes a material by a function of C that stands on this library, make(context, &out), such as one of
   * mpm_umat.h. */
  material(const context &made_with, const std::function<mpm_status(mpm_context *, mpm_material **)> &make)
      : wrapper(made_with.shared()) {
    detail::material_core &c = core();
    c.context->check(make(c.context->handle, &c.handle));
  }

  /** Runs the law without a grid: see mpm_material_update(). struct_size is set here. */
  void update(mpm_material_batch batch) const {
    batch.struct_size = sizeof batch;
    core().context->check(mpm_material_update(core().handle, &batch, nullptr, nullptr));
  }
  /** The same with the tangent of the step, [81][ld]. Returns whether it has major symmetry. */
  bool update(mpm_material_batch batch, span<double> tangent) const {
    batch.struct_size = sizeof batch;
    detail::expect_size("tangent", tangent.size(), 81 * batch.ld);
    int32_t symmetric = 0;
    core().context->check(mpm_material_update(core().handle, &batch, tangent.data(), &symmetric));
    return symmetric != 0;
  }
};

/** The names of the built-in laws: see mpm_material_model_name(). */
inline std::vector<std::string> models() {
  std::vector<std::string> names;
  for (int32_t i = 0; i < mpm_material_model_count(); ++i) names.emplace_back(mpm_material_model_name(i));
  return names;
}

/** The parameters of a built-in law: see mpm_material_model_param(). Throws error (MPM_E_NOT_FOUND) for an
 * unknown model. */
inline std::vector<parameter> model_parameters(const std::string &model) {
  std::vector<parameter> all;
  for (int32_t i = 0;; ++i) {
    const char *name = "", *unit = "", *text = "";
    parameter p{};
    if (mpm_material_model_param(model.c_str(), i, &name, &unit, &text, &p.value_default, &p.low, &p.high))
      break;
    p.name = name;
    p.unit = unit;
    p.text = text;
    all.push_back(p);
  }
  if (all.empty()) throw error(MPM_E_NOT_FOUND, "no built-in law \"" + model + "\"");
  return all;
}

/** What mpm_material_state_name() tells of a state variable of a built-in law. */
struct state_variable {
  std::string name; /**< name, such as "plastic_strain" */
  std::string unit; /**< unit as a dimension, such as "stress" */
  std::string text; /**< one line on its meaning */
};

/** The state variables of a built-in law, in the order of the field "state": see mpm_material_state_name().
 * Throws error (MPM_E_NOT_FOUND) for an unknown model. */
inline std::vector<state_variable> model_state(const std::string &model) {
  const int32_t count = mpm_material_state_count(model.c_str());
  if (count < 0) throw error(MPM_E_NOT_FOUND, "no built-in law \"" + model + "\"");
  std::vector<state_variable> all;
  for (int32_t i = 0; i < count; ++i) {
    const char *name = "", *unit = "", *text = "";
    mpm_material_state_name(model.c_str(), i, &name, &unit, &text);
    all.push_back({name, unit, text});
  }
  return all;
}

/** A field beside a batch, valid during the callback: see mpm_batch_field(). */
template <class T> struct batch_values {
  const T *data;            /**< address of component 0 of item 0 */
  int64_t component_stride; /**< distance from component c to c + 1, in elements */

  /** A stored component of an item of the batch. The indices are not checked. */
  const T &operator()(int64_t item, int32_t component = 0) const noexcept {
    return data[component * component_stride + item];
  }
};

/** Lends a field beside a batch: see mpm_batch_field(). T is the type of the field's elements, which the
 * library cannot check. Throws error, which in a callback stops the call that runs it. */
template <class T> batch_values<T> batch_field(const void *lookup, const std::string &field) {
  static_assert(detail::type_of<T>() != 0);
  const void *data = nullptr;
  batch_values<T> values{};
  if (const mpm_status status = mpm_batch_field(lookup, field.c_str(), &data, &values.component_stride))
    throw error(status, "mpm_batch_field: \"" + field + "\"");
  values.data = static_cast<const T *>(data);
  return values;
}

} // namespace mpm

#endif
