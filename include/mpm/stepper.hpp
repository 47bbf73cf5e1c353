/**
 * @file stepper.hpp
 * C++17: the time loop. See mpm.hpp.
 */
#ifndef MPM_STEPPER_HPP
#define MPM_STEPPER_HPP

#include <mpm/staged_step.hpp>

#include <algorithm>

namespace mpm {

/** A stepper: see stepper.h. It keeps its sets, obstacles and surfaces alive until they are removed or it
 * is destroyed. */
class stepper : public wrapper<detail::stepper_core> {
public:
  /** Makes a stepper: see mpm_stepper_create(). */
  explicit stepper(const grid &on, const mpm_stepper_desc &desc = stepper_desc()) : wrapper(on.shared()) {
    detail::stepper_core &c = core();
    check(mpm_stepper_create(c.context->handle, c.grid->handle, &desc, &c.handle));
  }

  /** Adds a set: see mpm_stepper_add(). */
  void add(particles &set) {
    core().sets.reserve(core().sets.size() + 1);
    check(mpm_stepper_add(core().handle, set.handle()));
    core().sets.push_back(set.shared());
  }
  /** Takes a set out: see mpm_stepper_remove(). */
  void remove(particles &set) {
    detail::stepper_core &c = core();
    check(mpm_stepper_remove(c.handle, set.handle()));
    c.sets.erase(std::find(c.sets.begin(), c.sets.end(), set.shared()));
    forget_motion(set.handle());
    forget_adaption(set.handle());
    forget_heat(set.handle());
  }
  /** Puts an obstacle in: see mpm_stepper_add_obstacle(). */
  void add(obstacle &body) {
    core().obstacles.reserve(core().obstacles.size() + 1);
    check(mpm_stepper_add_obstacle(core().handle, body.handle()));
    core().obstacles.push_back(body.shared());
  }
  /** Takes an obstacle out: see mpm_stepper_remove_obstacle(). */
  void remove(obstacle &body) {
    detail::stepper_core &c = core();
    check(mpm_stepper_remove_obstacle(c.handle, body.handle()));
    c.obstacles.erase(std::find(c.obstacles.begin(), c.obstacles.end(), body.shared()));
  }
  /** Puts a surface in: see mpm_stepper_add_surface(). */
  void add(surface &markers) {
    core().surfaces.reserve(core().surfaces.size() + 1);
    check(mpm_stepper_add_surface(core().handle, markers.handle()));
    core().surfaces.push_back(markers.shared());
  }
  /** Takes a surface out: see mpm_stepper_remove_surface(). */
  void remove(surface &markers) {
    detail::stepper_core &c = core();
    check(mpm_stepper_remove_surface(c.handle, markers.handle()));
    c.surfaces.erase(std::find(c.surfaces.begin(), c.surfaces.end(), markers.shared()));
  }
  /** Replaces the options: see mpm_stepper_configure(). */
  void configure(const mpm_stepper_desc &desc) {
    check(mpm_stepper_configure(core().handle, &desc));
  }
  /** Sets time and step: see mpm_stepper_set_time(). */
  void set_time(double t, int64_t step) {
    check(mpm_stepper_set_time(core().handle, t, step));
  }

  /** Sets what a face does: see mpm_stepper_set_wall(). */
  void set_wall(int32_t face, int32_t kind, double friction = 0.0) {
    check(mpm_stepper_set_wall(core().handle, face, kind, friction));
  }
  /** Puts a set into a body: see mpm_stepper_set_body(). */
  void set_body(const particles &set, int32_t body) {
    check(mpm_stepper_set_body(core().handle, set.handle(), body));
  }
  /** The body of a set: see mpm_stepper_body(). */
  int32_t body(const particles &set) const {
    int32_t body = 0;
    check(mpm_stepper_body(core().handle, set.handle(), &body));
    return body;
  }
  /** Sets how two bodies meet, or all with MPM_BODY_ANY: see mpm_stepper_set_contact(). */
  void set_contact(int32_t body_a, int32_t body_b, const mpm_contact_desc &desc) {
    check(mpm_stepper_set_contact(core().handle, body_a, body_b, &desc));
  }
  /** Takes back how two bodies meet: see mpm_stepper_set_contact(). */
  void reset_contact(int32_t body_a, int32_t body_b) {
    check(mpm_stepper_set_contact(core().handle, body_a, body_b, nullptr));
  }
  /** Sets what gives coefficients of friction; nullptr: none. See mpm_stepper_set_friction(). */
  void set_friction(friction_callback function) {
    install(mpm_stepper_set_friction, core().friction, std::move(function), core().on_contact);
  }
  /** Sets the mean velocity of a set's prescribed particles; nullptr: none. See mpm_stepper_set_motion(). */
  void set_motion(particles &set, particle_callback mean_velocity) {
    detail::stepper_core &c = core();
    c.motions.reserve(c.motions.size() + 1);
    auto rule = c.keep(std::move(mean_velocity));
    check(mpm_stepper_set_motion(c.handle, set.handle(), rule ? c.on_particles : nullptr, rule.get()));
    forget_motion(set.handle());
    if (rule) c.motions.push_back({set.handle(), std::move(rule)});
  }
  /** Sets how a set adapts, and what is asked before it does (nullptr: nothing is), whatever the description
   * has there. See mpm_stepper_set_adaption(). */
  void set_adaption(particles &set, mpm_adaption_desc desc, adaption_callback accept = nullptr) {
    detail::stepper_core &c = core();
    c.adaptions.reserve(c.adaptions.size() + 1);
    auto rule = c.keep(std::move(accept));
    desc.accept = rule ? c.on_adaption : nullptr;
    desc.user = rule.get();
    check(mpm_stepper_set_adaption(c.handle, set.handle(), &desc));
    forget_adaption(set.handle());
    if (rule) c.adaptions.push_back({set.handle(), std::move(rule)});
  }
  /** Lets a set adapt no longer. */
  void reset_adaption(particles &set) {
    check(mpm_stepper_set_adaption(core().handle, set.handle(), nullptr));
    forget_adaption(set.handle());
  }
  /** Adapts all sets that are described, now: see mpm_stepper_adapt(). */
  void adapt() {
    core().result(mpm_stepper_adapt(core().handle)).or_throw();
  }
  /** What adaption has done to a set: see mpm_stepper_adaption_info(). */
  mpm::adaption_info adaption(const particles &set) const {
    mpm::adaption_info info;
    check(mpm_stepper_adaption_info(core().handle, set.handle(), &info));
    return info;
  }
  /** Describes the heat of a set, and what heats it (nullptr: nothing), whatever the description has there.
   * See mpm_stepper_set_heat(). */
  void set_heat(particles &set, mpm_heat_desc desc, heat_callback source = nullptr) {
    detail::stepper_core &c = core();
    c.heats.reserve(c.heats.size() + 1);
    auto rule = c.keep(std::move(source));
    desc.source = rule ? c.on_heat : nullptr;
    desc.user = rule.get();
    check(mpm_stepper_set_heat(c.handle, set.handle(), &desc));
    forget_heat(set.handle());
    if (rule) c.heats.push_back({set.handle(), std::move(rule)});
  }
  /** The set has no heat any more. */
  void reset_heat(particles &set) {
    check(mpm_stepper_set_heat(core().handle, set.handle(), nullptr));
    forget_heat(set.handle());
  }
  /** Chooses how nodes conduct: see mpm_stepper_set_conduction(). */
  void set_conduction(int32_t conduction, double tolerance = 1e-9) {
    check(mpm_stepper_set_conduction(core().handle, conduction, tolerance));
  }
  /** Says what a face does to heat: see mpm_stepper_set_heat_wall(). */
  void set_heat_wall(int32_t face, int32_t kind, double temperature = 0.0) {
    check(mpm_stepper_set_heat_wall(core().handle, face, kind, temperature));
  }
  /** Where heat came from: see mpm_stepper_heat_info(). */
  mpm::heat_info heat() const {
    mpm::heat_info info;
    check(mpm_stepper_heat_info(core().handle, &info));
    return info;
  }
  /** What one part does of a problem in several: see mpm_stepper_parallel_info(). */
  mpm_parallel_info parallel(bool reset = false) const {
    mpm_parallel_info info = {};
    info.struct_size = sizeof info;
    check(mpm_stepper_parallel_info(core().handle, reset, &info));
    return info;
  }
  /** Sets how blocks are given to parts: see mpm_stepper_set_balance(). */
  void set_balance(const mpm_balance_desc &desc) {
    check(mpm_stepper_set_balance(core().handle, &desc));
  }
  /** Sets the acceleration of particles; nullptr: none. See mpm_stepper_set_acceleration(). */
  void set_acceleration(particle_callback function) {
    install(mpm_stepper_set_acceleration, core().acceleration, std::move(function), core().on_particles);
  }
  /** Sets the force on particles; nullptr: none. See mpm_stepper_set_force(). */
  void set_force(particle_callback function) {
    install(mpm_stepper_set_force, core().force, std::move(function), core().on_particles);
  }
  /** Sets what prescribes nodal velocities; nullptr: none. See mpm_stepper_set_velocity_bc(). */
  void set_velocity_bc(velocity_callback function) {
    install(mpm_stepper_set_velocity_bc, core().velocity, std::move(function), core().on_velocity);
  }
  /** Sets the hook of a stage, MPM_AFTER_P2G to MPM_AFTER_VELOCITY; nullptr: none. See
   * mpm_stepper_set_node_hook(). */
  void set_node_hook(int32_t stage, node_callback function) {
    const auto set = [stage](mpm_stepper *s, mpm_node_fn fn, void *user) {
      return mpm_stepper_set_node_hook(s, stage, fn, user);
    };
    std::unique_ptr<detail::stepper_core::slot<node_callback>> refused;
    const bool known = stage >= MPM_AFTER_P2G && stage <= MPM_AFTER_VELOCITY;
    auto &place = known ? core().hooks[static_cast<std::size_t>(stage - MPM_AFTER_P2G)] : refused;
    install(set, place, std::move(function), core().on_nodes);
  }
  /** Sets the solver of MPM_SOLVER_HOST; nullptr: none. See mpm_stepper_set_linear_solver(). */
  void set_linear_solver(solve_callback function) {
    install(mpm_stepper_set_linear_solver, core().solver, std::move(function), core().on_solve);
  }
  /** Sets what watches steps; nullptr: none. See mpm_stepper_set_progress(). */
  void set_progress(progress_callback function) {
    install(mpm_stepper_set_progress, core().progress, std::move(function), core().on_progress);
  }

  /** The stable dt: see mpm_stable_dt(). Throws error for any status but MPM_OK. */
  double stable_dt() {
    double dt = 0.0;
    check(mpm_stable_dt(core().handle, &dt));
    return dt;
  }
  /** Makes a step: see mpm_step(). */
  outcome step(double dt) {
    return core().result(mpm_step(core().handle, dt, nullptr));
  }
  /** Makes a step and fills info, on success and on failure, also when it throws. */
  outcome step(double dt, mpm_step_info &info) {
    return core().result(mpm_step(core().handle, dt, &info));
  }
  /** Steps to a time: see mpm_advance(). */
  outcome advance(const mpm_advance_desc &desc) {
    return core().result(mpm_advance(core().handle, &desc, nullptr));
  }
  /** Steps to a time and fills info with that of the last sub-step tried. */
  outcome advance(const mpm_advance_desc &desc, mpm_step_info &info) {
    return core().result(mpm_advance(core().handle, &desc, &info));
  }
  /** Begins a step in parts: see mpm_step_begin(). */
  staged_step begin(double dt) {
    return staged_step(shared(), dt);
  }

  /** The info of the state as it is: see mpm_stepper_info(). */
  step_info info() const {
    step_info now;
    check(mpm_stepper_info(core().handle, &now));
    return now;
  }
  /** The times since creation or the last reset: see mpm_stepper_profile(). */
  mpm_profile profile(bool reset = false) {
    mpm_profile times{};
    times.struct_size = sizeof times;
    check(mpm_stepper_profile(core().handle, reset, &times));
    return times;
  }
  /** The residuals of the last implicit step: see mpm_stepper_residuals(). */
  std::vector<double> residuals() const {
    int32_t count = 0;
    check(mpm_stepper_residuals(core().handle, 0, nullptr, &count));
    std::vector<double> all(static_cast<std::size_t>(count));
    if (count) check(mpm_stepper_residuals(core().handle, count, all.data(), &count));
    return all;
  }
  /** Lends a nodal field: see mpm_grid_map(). map<const double>() is for reading, map<double>() for reading
   * and writing. */
  template <class T> view<T> map(const std::string &field, int32_t body = 0) {
    return view<T>(shared(), field, [&](int32_t access, mpm_view *out) {
      return mpm_grid_map(core().handle, body, field.c_str(), access, out);
    });
  }
  /** The force of a wall on the material: see mpm_stepper_wall_reaction(). Entries of unused axes are 0. */
  std::array<double, 3> wall_reaction(int32_t face) const {
    std::array<double, 3> force{};
    check(mpm_stepper_wall_reaction(core().handle, face, force.data()));
    return force;
  }
  /** The force of a set's prescribed particles on the material: see mpm_stepper_particles_reaction(). */
  std::array<double, 3> particles_reaction(const particles &set) const {
    std::array<double, 3> force{};
    check(mpm_stepper_particles_reaction(core().handle, set.handle(), force.data()));
    return force;
  }
  /** The force of what a surface prescribes on the material: see mpm_stepper_surface_reaction(). */
  std::array<double, 3> surface_reaction(const surface &markers) const {
    std::array<double, 3> force{};
    check(mpm_stepper_surface_reaction(core().handle, markers.handle(), force.data()));
    return force;
  }
  /** The impulse of it over all steps: see mpm_stepper_surface_impulse(). */
  std::array<double, 3> surface_impulse(const surface &markers) const {
    std::array<double, 3> impulse{};
    check(mpm_stepper_surface_impulse(core().handle, markers.handle(), impulse.data()));
    return impulse;
  }
  /** What two bodies did to each other in the last step: see mpm_stepper_contact_info(). */
  mpm::contact_info contact(int32_t body_a, int32_t body_b) const {
    mpm::contact_info info;
    check(mpm_stepper_contact_info(core().handle, body_a, body_b, &info));
    return info;
  }
  /** The impulse of a wall on the material over all steps: see mpm_stepper_wall_impulse(). */
  std::array<double, 3> wall_impulse(int32_t face) const {
    std::array<double, 3> impulse{};
    check(mpm_stepper_wall_impulse(core().handle, face, impulse.data()));
    return impulse;
  }
  /** The impulse of a set's prescribed particles over all steps: see mpm_stepper_particles_impulse(). */
  std::array<double, 3> particles_impulse(const particles &set) const {
    std::array<double, 3> impulse{};
    check(mpm_stepper_particles_impulse(core().handle, set.handle(), impulse.data()));
    return impulse;
  }

  /** The saved state: see mpm_state_save(). */
  std::vector<unsigned char> save() const {
    int64_t bytes = 0;
    check(mpm_state_size(core().handle, &bytes));
    std::vector<unsigned char> state(static_cast<std::size_t>(bytes));
    check(mpm_state_save(core().handle, state.data(), bytes));
    return state;
  }
  /** Replaces the state by a saved one: see mpm_state_load(). */
  void load(span<const unsigned char> state) {
    check(mpm_state_load(core().handle, detail::not_null(state), static_cast<int64_t>(state.size())));
  }
  /** Replaces the state by one in pieces, of which these are this part's: see mpm_state_load_pieces(). */
  void load_pieces(const std::vector<span<const unsigned char>> &pieces) {
    std::vector<const void *> data;
    std::vector<int64_t> bytes;
    for (const span<const unsigned char> &one : pieces) {
      data.push_back(detail::not_null(one));
      bytes.push_back(static_cast<int64_t>(one.size()));
    }
    check(
        mpm_state_load_pieces(core().handle, static_cast<int32_t>(pieces.size()), data.data(), bytes.data()));
  }
  /** Saves the state into a file: see mpm_state_save_file(). */
  void save_file(const std::string &path) const {
    check(mpm_state_save_file(core().handle, path.c_str()));
  }
  /** Gives the bytes of the state to a function: see mpm_state_save_to(). */
  void save_to(const write_callback &write) const {
    detail::byte_taker taker{write, core().context->exceptions};
    check(mpm_state_save_to(core().handle, write ? detail::byte_taker::write : nullptr, &taker));
  }
  /** Replaces the state by one from a file: see mpm_state_load_file(). */
  void load_file(const std::string &path) {
    check(mpm_state_load_file(core().handle, path.c_str()));
  }
  /** A hash of the state: see mpm_state_hash(). */
  uint64_t hash() const {
    uint64_t hash = 0;
    check(mpm_state_hash(core().handle, &hash));
    return hash;
  }
  /** Writes a .vti file (with open knots a .vtr file) with the named nodal fields, or with all: see
   * mpm_write_grid(). */
  void write_grid(const std::string &path, const std::vector<std::string> &names = {}) {
    check(mpm_write_grid(core().handle, path.c_str(), static_cast<int32_t>(names.size()),
                         detail::c_names(names).data()));
  }
  /** Does the same for the nodes of a body: see mpm_write_body_grid(). */
  void write_body_grid(int32_t body, const std::string &path, const std::vector<std::string> &names = {}) {
    check(mpm_write_body_grid(core().handle, body, path.c_str(), static_cast<int32_t>(names.size()),
                              detail::c_names(names).data()));
  }
  /** Gives the bytes of that file to a function: see mpm_write_grid_to(). */
  void write_grid_to(int32_t body, const write_callback &write, const std::vector<std::string> &names = {}) {
    detail::byte_taker taker{write, core().context->exceptions};
    check(mpm_write_grid_to(core().handle, body, write ? detail::byte_taker::write : nullptr, &taker,
                            static_cast<int32_t>(names.size()), detail::c_names(names).data()));
  }

private:
  void check(mpm_status status) const {
    core().result(status).or_throw();
  }
  /* The old function goes only once the library has taken the new one. */
  template <class Set, class F, class Fn>
  void install(Set set, std::unique_ptr<detail::stepper_core::slot<F>> &place, F function, Fn *trampoline) {
    auto fresh = core().keep(std::move(function));
    check(set(core().handle, fresh ? trampoline : nullptr, fresh.get()));
    place = std::move(fresh);
  }
  void forget_adaption(const mpm_particles *set) {
    auto &all = core().adaptions;
    all.erase(std::remove_if(all.begin(), all.end(), [set](const auto &a) { return a.set == set; }),
              all.end());
  }
  void forget_heat(const mpm_particles *set) {
    auto &all = core().heats;
    all.erase(std::remove_if(all.begin(), all.end(), [set](const auto &h) { return h.set == set; }),
              all.end());
  }
  void forget_motion(const mpm_particles *set) {
    auto &all = core().motions;
    all.erase(std::remove_if(all.begin(), all.end(), [set](const auto &m) { return m.set == set; }),
              all.end());
  }
};

} // namespace mpm

#endif
