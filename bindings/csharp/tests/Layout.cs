// Generated from the headers of libmpm by `make api`; not to be edited.
// Whether structs lie in memory as those of C, and whether the library has every function.
using System;
using System.Runtime.InteropServices;

namespace Mpm {
  static unsafe class Layout {
    static int wrong;

    static void Compare(string what, long found, int wide, int narrow) {
      int should = IntPtr.Size == 8 ? wide : narrow;
      if (found == should) return;
      Console.Error.WriteLine("{0}: {1}, in C {2}", what, found, should);
      wrong++;
    }

    static void CheckParam() {
      var it = new Param();
      byte* at = (byte*)&it;
      Compare("Param", sizeof(Param), 16, 16);
      Compare("Param.name", (byte*)&it.name - at, 0, 0);
      Compare("Param.value", (byte*)&it.value - at, 8, 8);
    }

    static void CheckView() {
      var it = new View();
      byte* at = (byte*)&it;
      Compare("View", sizeof(View), 56, 48);
      Compare("View.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("View.type", (byte*)&it.type - at, 4, 4);
      Compare("View.components", (byte*)&it.components - at, 8, 8);
      Compare("View.access", (byte*)&it.access - at, 12, 12);
      Compare("View.count", (byte*)&it.count - at, 16, 16);
      Compare("View.item_stride", (byte*)&it.item_stride - at, 24, 24);
      Compare("View.component_stride", (byte*)&it.component_stride - at, 32, 32);
      Compare("View.data", (byte*)&it.data - at, 40, 40);
      Compare("View.owner", (byte*)&it.owner - at, 48, 44);
    }

    static void CheckMessage() {
      var it = new Message();
      byte* at = (byte*)&it;
      Compare("Message", sizeof(Message), 24, 24);
      Compare("Message.part", (byte*)&it.part - at, 0, 0);
      Compare("Message.reserved", (byte*)&it.reserved - at, 4, 4);
      Compare("Message.bytes", (byte*)&it.bytes - at, 8, 8);
      Compare("Message.data", (byte*)&it.data - at, 16, 16);
    }

    static void CheckTransport() {
      var it = new Transport();
      byte* at = (byte*)&it;
      Compare("Transport", sizeof(Transport), 64, 40);
      Compare("Transport.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("Transport.part", (byte*)&it.part - at, 4, 4);
      Compare("Transport.parts", (byte*)&it.parts - at, 8, 8);
      Compare("Transport.reserved", (byte*)&it.reserved - at, 12, 12);
      Compare("Transport.send", (byte*)&it.send - at, 16, 16);
      Compare("Transport.receive", (byte*)&it.receive - at, 24, 20);
      Compare("Transport.reduce", (byte*)&it.reduce - at, 32, 24);
      Compare("Transport.gather", (byte*)&it.gather - at, 40, 28);
      Compare("Transport.poll", (byte*)&it.poll - at, 48, 32);
      Compare("Transport.user", (byte*)&it.user - at, 56, 36);
    }

    static void CheckBalanceDesc() {
      var it = new BalanceDesc();
      byte* at = (byte*)&it;
      Compare("BalanceDesc", sizeof(BalanceDesc), 24, 24);
      Compare("BalanceDesc.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("BalanceDesc.measure", (byte*)&it.measure - at, 4, 4);
      Compare("BalanceDesc.limit", (byte*)&it.limit - at, 8, 8);
      Compare("BalanceDesc.block_weight", (byte*)&it.block_weight - at, 16, 16);
    }

    static void CheckParallelInfo() {
      var it = new ParallelInfo();
      byte* at = (byte*)&it;
      Compare("ParallelInfo", sizeof(ParallelInfo), 96, 96);
      Compare("ParallelInfo.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("ParallelInfo.neighbours", (byte*)&it.neighbours - at, 4, 4);
      Compare("ParallelInfo.blocks", (byte*)&it.blocks - at, 8, 8);
      Compare("ParallelInfo.boundary", (byte*)&it.boundary - at, 16, 16);
      Compare("ParallelInfo.ghosts", (byte*)&it.ghosts - at, 24, 24);
      Compare("ParallelInfo.bytes_nodes", (byte*)&it.bytes_nodes - at, 32, 32);
      Compare("ParallelInfo.bytes_moved", (byte*)&it.bytes_moved - at, 40, 40);
      Compare("ParallelInfo.moved", (byte*)&it.moved - at, 48, 48);
      Compare("ParallelInfo.cuts", (byte*)&it.cuts - at, 56, 56);
      Compare("ParallelInfo.imbalance", (byte*)&it.imbalance - at, 64, 64);
      Compare("ParallelInfo.seconds_packing", (byte*)&it.seconds_packing - at, 72, 72);
      Compare("ParallelInfo.seconds_waiting", (byte*)&it.seconds_waiting - at, 80, 80);
      Compare("ParallelInfo.seconds_reducing", (byte*)&it.seconds_reducing - at, 88, 88);
    }

    static void CheckContextDesc() {
      var it = new ContextDesc();
      byte* at = (byte*)&it;
      Compare("ContextDesc", sizeof(ContextDesc), 96, 64);
      Compare("ContextDesc.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("ContextDesc.concurrency", (byte*)&it.concurrency - at, 4, 4);
      Compare("ContextDesc.isa", (byte*)&it.isa - at, 8, 8);
      Compare("ContextDesc.serial_callbacks", (byte*)&it.serial_callbacks - at, 12, 12);
      Compare("ContextDesc.alloc", (byte*)&it.alloc - at, 16, 16);
      Compare("ContextDesc.release", (byte*)&it.release - at, 24, 20);
      Compare("ContextDesc.alloc_user", (byte*)&it.alloc_user - at, 32, 24);
      Compare("ContextDesc.parallel_for", (byte*)&it.parallel_for - at, 40, 28);
      Compare("ContextDesc.parallel_user", (byte*)&it.parallel_user - at, 48, 32);
      Compare("ContextDesc.log", (byte*)&it.log - at, 56, 36);
      Compare("ContextDesc.log_user", (byte*)&it.log_user - at, 64, 40);
      Compare("ContextDesc.error_text", (byte*)&it.error_text - at, 72, 44);
      Compare("ContextDesc.error_bytes", (byte*)&it.error_bytes - at, 80, 48);
      Compare("ContextDesc.transport", (byte*)&it.transport - at, 88, 56);
    }

    static void CheckGridDesc() {
      var it = new GridDesc();
      byte* at = (byte*)&it;
      Compare("GridDesc", sizeof(GridDesc), 120, 120);
      Compare("GridDesc.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("GridDesc.dim", (byte*)&it.dim - at, 4, 4);
      Compare("GridDesc.basis", (byte*)&it.basis - at, 8, 8);
      Compare("GridDesc.boundary_basis", (byte*)&it.boundary_basis - at, 12, 12);
      Compare("GridDesc.periodic", (byte*)it.periodic - at, 16, 16);
      Compare("GridDesc.geometry", (byte*)&it.geometry - at, 28, 28);
      Compare("GridDesc.cells", (byte*)it.cells - at, 32, 32);
      Compare("GridDesc.origin", (byte*)it.origin - at, 56, 56);
      Compare("GridDesc.spacing", (byte*)it.spacing - at, 80, 80);
      Compare("GridDesc.smoothing", (byte*)&it.smoothing - at, 104, 104);
      Compare("GridDesc.total_lagrangian", (byte*)&it.total_lagrangian - at, 112, 112);
      Compare("GridDesc.reserved", (byte*)&it.reserved - at, 116, 116);
    }

    static void CheckMaterialBatch() {
      var it = new MaterialBatch();
      byte* at = (byte*)&it;
      Compare("MaterialBatch", sizeof(MaterialBatch), 144, 96);
      Compare("MaterialBatch.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("MaterialBatch.state_count", (byte*)&it.state_count - at, 4, 4);
      Compare("MaterialBatch.n", (byte*)&it.n - at, 8, 8);
      Compare("MaterialBatch.ld", (byte*)&it.ld - at, 16, 16);
      Compare("MaterialBatch.t", (byte*)&it.t - at, 24, 24);
      Compare("MaterialBatch.dt", (byte*)&it.dt - at, 32, 32);
      Compare("MaterialBatch.id", (byte*)&it.id - at, 40, 40);
      Compare("MaterialBatch.F", (byte*)&it.F - at, 48, 44);
      Compare("MaterialBatch.F_inc", (byte*)&it.F_inc - at, 56, 48);
      Compare("MaterialBatch.L", (byte*)&it.L - at, 64, 52);
      Compare("MaterialBatch.stress", (byte*)&it.stress - at, 72, 56);
      Compare("MaterialBatch.state", (byte*)&it.state - at, 80, 60);
      Compare("MaterialBatch.stress_new", (byte*)&it.stress_new - at, 88, 64);
      Compare("MaterialBatch.state_new", (byte*)&it.state_new - at, 96, 68);
      Compare("MaterialBatch.wave_speed", (byte*)&it.wave_speed - at, 104, 72);
      Compare("MaterialBatch.kinematic_viscosity", (byte*)&it.kinematic_viscosity - at, 112, 76);
      Compare("MaterialBatch.energy", (byte*)&it.energy - at, 120, 80);
      Compare("MaterialBatch.position", (byte*)&it.position - at, 128, 84);
      Compare("MaterialBatch.lookup", (byte*)&it.lookup - at, 136, 88);
    }

    static void CheckMaterialDesc() {
      var it = new MaterialDesc();
      byte* at = (byte*)&it;
      Compare("MaterialDesc", sizeof(MaterialDesc), 64, 48);
      Compare("MaterialDesc.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("MaterialDesc.state_count", (byte*)&it.state_count - at, 4, 4);
      Compare("MaterialDesc.tangent_form", (byte*)&it.tangent_form - at, 8, 8);
      Compare("MaterialDesc.reserved", (byte*)&it.reserved - at, 12, 12);
      Compare("MaterialDesc.density", (byte*)&it.density - at, 16, 16);
      Compare("MaterialDesc.stress", (byte*)&it.stress - at, 24, 24);
      Compare("MaterialDesc.tangent", (byte*)&it.tangent - at, 32, 28);
      Compare("MaterialDesc.user", (byte*)&it.user - at, 40, 32);
      Compare("MaterialDesc.release_user", (byte*)&it.release_user - at, 48, 36);
      Compare("MaterialDesc.state_initial", (byte*)&it.state_initial - at, 56, 40);
    }

    static void CheckOperatorInfo() {
      var it = new OperatorInfo();
      byte* at = (byte*)&it;
      Compare("OperatorInfo", sizeof(OperatorInfo), 104, 96);
      Compare("OperatorInfo.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("OperatorInfo.block", (byte*)&it.block - at, 4, 4);
      Compare("OperatorInfo.symmetric", (byte*)&it.symmetric - at, 8, 8);
      Compare("OperatorInfo.positive_definite", (byte*)&it.positive_definite - at, 12, 12);
      Compare("OperatorInfo.rows", (byte*)&it.rows - at, 16, 16);
      Compare("OperatorInfo.nonzeros", (byte*)&it.nonzeros - at, 24, 24);
      Compare("OperatorInfo.pattern_id", (byte*)&it.pattern_id - at, 32, 32);
      Compare("OperatorInfo.ld", (byte*)&it.ld - at, 40, 40);
      Compare("OperatorInfo.node", (byte*)&it.node - at, 48, 48);
      Compare("OperatorInfo.component", (byte*)&it.component - at, 56, 52);
      Compare("OperatorInfo.position", (byte*)&it.position - at, 64, 56);
      Compare("OperatorInfo.first_row", (byte*)&it.first_row - at, 72, 64);
      Compare("OperatorInfo.owned_rows", (byte*)&it.owned_rows - at, 80, 72);
      Compare("OperatorInfo.all_rows", (byte*)&it.all_rows - at, 88, 80);
      Compare("OperatorInfo.number", (byte*)&it.number - at, 96, 88);
    }

    static void CheckStepperDesc() {
      var it = new StepperDesc();
      byte* at = (byte*)&it;
      Compare("StepperDesc", sizeof(StepperDesc), 176, 176);
      Compare("StepperDesc.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("StepperDesc.scheme", (byte*)&it.scheme - at, 4, 4);
      Compare("StepperDesc.transfer", (byte*)&it.transfer - at, 8, 8);
      Compare("StepperDesc.xpic_order", (byte*)&it.xpic_order - at, 12, 12);
      Compare("StepperDesc.position_order", (byte*)&it.position_order - at, 16, 16);
      Compare("StepperDesc.locking_remedy", (byte*)&it.locking_remedy - at, 20, 20);
      Compare("StepperDesc.reference_positions", (byte*)&it.reference_positions - at, 24, 24);
      Compare("StepperDesc.quasi_static", (byte*)&it.quasi_static - at, 28, 28);
      Compare("StepperDesc.staggered", (byte*)&it.staggered - at, 32, 32);
      Compare("StepperDesc.boundary_zero_acceleration", (byte*)&it.boundary_zero_acceleration - at, 36, 36);
      Compare("StepperDesc.flip", (byte*)&it.flip - at, 40, 40);
      Compare("StepperDesc.pic_damping", (byte*)&it.pic_damping - at, 48, 48);
      Compare("StepperDesc.gravity", (byte*)it.gravity - at, 56, 56);
      Compare("StepperDesc.newmark_beta", (byte*)&it.newmark_beta - at, 80, 80);
      Compare("StepperDesc.newmark_gamma", (byte*)&it.newmark_gamma - at, 88, 88);
      Compare("StepperDesc.newton_tolerance_displacement", (byte*)&it.newton_tolerance_displacement - at, 96, 96);
      Compare("StepperDesc.newton_tolerance_energy", (byte*)&it.newton_tolerance_energy - at, 104, 104);
      Compare("StepperDesc.newton_tolerance_residual", (byte*)&it.newton_tolerance_residual - at, 112, 112);
      Compare("StepperDesc.newton_residual_floor", (byte*)&it.newton_residual_floor - at, 120, 120);
      Compare("StepperDesc.newton_max_iterations", (byte*)&it.newton_max_iterations - at, 128, 128);
      Compare("StepperDesc.linear_solver", (byte*)&it.linear_solver - at, 132, 132);
      Compare("StepperDesc.linear_tolerance", (byte*)&it.linear_tolerance - at, 136, 136);
      Compare("StepperDesc.linear_max_iterations", (byte*)&it.linear_max_iterations - at, 144, 144);
      Compare("StepperDesc.projected_positions", (byte*)&it.projected_positions - at, 148, 148);
      Compare("StepperDesc.local_damping", (byte*)&it.local_damping - at, 152, 152);
      Compare("StepperDesc.mass_damping", (byte*)&it.mass_damping - at, 160, 160);
      Compare("StepperDesc.xpic_every", (byte*)&it.xpic_every - at, 168, 168);
      Compare("StepperDesc.reserved", (byte*)&it.reserved - at, 172, 172);
    }

    static void CheckStepInfo() {
      var it = new StepInfo();
      byte* at = (byte*)&it;
      Compare("StepInfo", sizeof(StepInfo), 248, 248);
      Compare("StepInfo.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("StepInfo.cause", (byte*)&it.cause - at, 4, 4);
      Compare("StepInfo.callback_status", (byte*)&it.callback_status - at, 8, 8);
      Compare("StepInfo.newton_iterations", (byte*)&it.newton_iterations - at, 12, 12);
      Compare("StepInfo.linear_solver", (byte*)&it.linear_solver - at, 16, 16);
      Compare("StepInfo.set", (byte*)&it.set - at, 20, 20);
      Compare("StepInfo.step", (byte*)&it.step - at, 24, 24);
      Compare("StepInfo.active_nodes", (byte*)&it.active_nodes - at, 32, 32);
      Compare("StepInfo.removed", (byte*)&it.removed - at, 40, 40);
      Compare("StepInfo.resorts", (byte*)&it.resorts - at, 48, 48);
      Compare("StepInfo.particle", (byte*)&it.particle - at, 56, 56);
      Compare("StepInfo.node", (byte*)&it.node - at, 64, 64);
      Compare("StepInfo.linear_iterations", (byte*)&it.linear_iterations - at, 72, 72);
      Compare("StepInfo.t", (byte*)&it.t - at, 80, 80);
      Compare("StepInfo.dt", (byte*)&it.dt - at, 88, 88);
      Compare("StepInfo.dt_suggested", (byte*)&it.dt_suggested - at, 96, 96);
      Compare("StepInfo.residual", (byte*)&it.residual - at, 104, 104);
      Compare("StepInfo.kinetic_energy", (byte*)&it.kinetic_energy - at, 112, 112);
      Compare("StepInfo.strain_energy", (byte*)&it.strain_energy - at, 120, 120);
      Compare("StepInfo.external_work", (byte*)&it.external_work - at, 128, 128);
      Compare("StepInfo.dissipation", (byte*)&it.dissipation - at, 136, 136);
      Compare("StepInfo.momentum", (byte*)it.momentum - at, 144, 144);
      Compare("StepInfo.angular_momentum", (byte*)it.angular_momentum - at, 168, 168);
      Compare("StepInfo.external_work_total", (byte*)&it.external_work_total - at, 192, 192);
      Compare("StepInfo.affine_kinetic_energy", (byte*)&it.affine_kinetic_energy - at, 200, 200);
      Compare("StepInfo.contact_dissipation", (byte*)&it.contact_dissipation - at, 208, 208);
      Compare("StepInfo.contact_nodes", (byte*)&it.contact_nodes - at, 216, 216);
      Compare("StepInfo.body", (byte*)&it.body - at, 224, 224);
      Compare("StepInfo.reserved", (byte*)&it.reserved - at, 228, 228);
      Compare("StepInfo.damping_dissipation", (byte*)&it.damping_dissipation - at, 232, 232);
      Compare("StepInfo.damping_dissipation_total", (byte*)&it.damping_dissipation_total - at, 240, 240);
    }

    static void CheckParticleBatch() {
      var it = new ParticleBatch();
      byte* at = (byte*)&it;
      Compare("ParticleBatch", sizeof(ParticleBatch), 104, 72);
      Compare("ParticleBatch.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("ParticleBatch.dim", (byte*)&it.dim - at, 4, 4);
      Compare("ParticleBatch.n", (byte*)&it.n - at, 8, 8);
      Compare("ParticleBatch.ld", (byte*)&it.ld - at, 16, 16);
      Compare("ParticleBatch.t", (byte*)&it.t - at, 24, 24);
      Compare("ParticleBatch.dt", (byte*)&it.dt - at, 32, 32);
      Compare("ParticleBatch.id", (byte*)&it.id - at, 40, 40);
      Compare("ParticleBatch.position", (byte*)&it.position - at, 48, 44);
      Compare("ParticleBatch.reference_position", (byte*)&it.reference_position - at, 56, 48);
      Compare("ParticleBatch.velocity", (byte*)&it.velocity - at, 64, 52);
      Compare("ParticleBatch.mass", (byte*)&it.mass - at, 72, 56);
      Compare("ParticleBatch.volume", (byte*)&it.volume - at, 80, 60);
      Compare("ParticleBatch.particles", (byte*)&it.particles - at, 88, 64);
      Compare("ParticleBatch.lookup", (byte*)&it.lookup - at, 96, 68);
    }

    static void CheckNodeBatch() {
      var it = new NodeBatch();
      byte* at = (byte*)&it;
      Compare("NodeBatch", sizeof(NodeBatch), 80, 64);
      Compare("NodeBatch.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("NodeBatch.dim", (byte*)&it.dim - at, 4, 4);
      Compare("NodeBatch.body", (byte*)&it.body - at, 8, 8);
      Compare("NodeBatch.reserved", (byte*)&it.reserved - at, 12, 12);
      Compare("NodeBatch.n", (byte*)&it.n - at, 16, 16);
      Compare("NodeBatch.ld", (byte*)&it.ld - at, 24, 24);
      Compare("NodeBatch.t", (byte*)&it.t - at, 32, 32);
      Compare("NodeBatch.dt", (byte*)&it.dt - at, 40, 40);
      Compare("NodeBatch.index", (byte*)&it.index - at, 48, 48);
      Compare("NodeBatch.position", (byte*)&it.position - at, 56, 52);
      Compare("NodeBatch.mass", (byte*)&it.mass - at, 64, 56);
      Compare("NodeBatch.owned", (byte*)&it.owned - at, 72, 60);
    }

    static void CheckAdvanceDesc() {
      var it = new AdvanceDesc();
      byte* at = (byte*)&it;
      Compare("AdvanceDesc", sizeof(AdvanceDesc), 56, 56);
      Compare("AdvanceDesc.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("AdvanceDesc.max_cuts", (byte*)&it.max_cuts - at, 4, 4);
      Compare("AdvanceDesc.t_end", (byte*)&it.t_end - at, 8, 8);
      Compare("AdvanceDesc.cfl", (byte*)&it.cfl - at, 16, 16);
      Compare("AdvanceDesc.dt_first", (byte*)&it.dt_first - at, 24, 24);
      Compare("AdvanceDesc.dt_min", (byte*)&it.dt_min - at, 32, 32);
      Compare("AdvanceDesc.dt_max", (byte*)&it.dt_max - at, 40, 40);
      Compare("AdvanceDesc.max_steps", (byte*)&it.max_steps - at, 48, 48);
    }

    static void CheckProfile() {
      var it = new Profile();
      byte* at = (byte*)&it;
      Compare("Profile", sizeof(Profile), 96, 96);
      Compare("Profile.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("Profile.reserved", (byte*)&it.reserved - at, 4, 4);
      Compare("Profile.sort", (byte*)&it.sort - at, 8, 8);
      Compare("Profile.p2g", (byte*)&it.p2g - at, 16, 16);
      Compare("Profile.grid", (byte*)&it.grid - at, 24, 24);
      Compare("Profile.g2p", (byte*)&it.g2p - at, 32, 32);
      Compare("Profile.law", (byte*)&it.law - at, 40, 40);
      Compare("Profile.assembly", (byte*)&it.assembly - at, 48, 48);
      Compare("Profile.factor", (byte*)&it.factor - at, 56, 56);
      Compare("Profile.solve", (byte*)&it.solve - at, 64, 64);
      Compare("Profile.callbacks", (byte*)&it.callbacks - at, 72, 72);
      Compare("Profile.total", (byte*)&it.total - at, 80, 80);
      Compare("Profile.weights", (byte*)&it.weights - at, 88, 88);
    }

    static void CheckContactDesc() {
      var it = new ContactDesc();
      byte* at = (byte*)&it;
      Compare("ContactDesc", sizeof(ContactDesc), 72, 72);
      Compare("ContactDesc.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("ContactDesc.kind", (byte*)&it.kind - at, 4, 4);
      Compare("ContactDesc.normal", (byte*)&it.normal - at, 8, 8);
      Compare("ContactDesc.detection", (byte*)&it.detection - at, 12, 12);
      Compare("ContactDesc.friction", (byte*)&it.friction - at, 16, 16);
      Compare("ContactDesc.friction_static", (byte*)&it.friction_static - at, 24, 24);
      Compare("ContactDesc.adhesion", (byte*)&it.adhesion - at, 32, 32);
      Compare("ContactDesc.offset", (byte*)&it.offset - at, 40, 40);
      Compare("ContactDesc.direction", (byte*)it.direction - at, 48, 48);
    }

    static void CheckContactInfo() {
      var it = new ContactInfo();
      byte* at = (byte*)&it;
      Compare("ContactInfo", sizeof(ContactInfo), 160, 160);
      Compare("ContactInfo.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("ContactInfo.touching", (byte*)&it.touching - at, 4, 4);
      Compare("ContactInfo.nodes", (byte*)&it.nodes - at, 8, 8);
      Compare("ContactInfo.closed", (byte*)&it.closed - at, 16, 16);
      Compare("ContactInfo.stuck", (byte*)&it.stuck - at, 24, 24);
      Compare("ContactInfo.ambiguous", (byte*)&it.ambiguous - at, 32, 32);
      Compare("ContactInfo.force", (byte*)it.force - at, 40, 40);
      Compare("ContactInfo.torque", (byte*)it.torque - at, 64, 64);
      Compare("ContactInfo.normal_force", (byte*)&it.normal_force - at, 88, 88);
      Compare("ContactInfo.area", (byte*)&it.area - at, 96, 96);
      Compare("ContactInfo.pressure_max", (byte*)&it.pressure_max - at, 104, 104);
      Compare("ContactInfo.gap", (byte*)&it.gap - at, 112, 112);
      Compare("ContactInfo.dissipation", (byte*)&it.dissipation - at, 120, 120);
      Compare("ContactInfo.friction_work", (byte*)&it.friction_work - at, 128, 128);
      Compare("ContactInfo.impulse", (byte*)it.impulse - at, 136, 136);
    }

    static void CheckContactBatch() {
      var it = new ContactBatch();
      byte* at = (byte*)&it;
      Compare("ContactBatch", sizeof(ContactBatch), 96, 72);
      Compare("ContactBatch.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("ContactBatch.dim", (byte*)&it.dim - at, 4, 4);
      Compare("ContactBatch.body_a", (byte*)&it.body_a - at, 8, 8);
      Compare("ContactBatch.body_b", (byte*)&it.body_b - at, 12, 12);
      Compare("ContactBatch.n", (byte*)&it.n - at, 16, 16);
      Compare("ContactBatch.ld", (byte*)&it.ld - at, 24, 24);
      Compare("ContactBatch.t", (byte*)&it.t - at, 32, 32);
      Compare("ContactBatch.dt", (byte*)&it.dt - at, 40, 40);
      Compare("ContactBatch.position", (byte*)&it.position - at, 48, 48);
      Compare("ContactBatch.normal", (byte*)&it.normal - at, 56, 52);
      Compare("ContactBatch.gap", (byte*)&it.gap - at, 64, 56);
      Compare("ContactBatch.area", (byte*)&it.area - at, 72, 60);
      Compare("ContactBatch.slip", (byte*)&it.slip - at, 80, 64);
      Compare("ContactBatch.pressure", (byte*)&it.pressure - at, 88, 68);
    }

    static void CheckDistanceBatch() {
      var it = new DistanceBatch();
      byte* at = (byte*)&it;
      Compare("DistanceBatch", sizeof(DistanceBatch), 64, 48);
      Compare("DistanceBatch.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("DistanceBatch.dim", (byte*)&it.dim - at, 4, 4);
      Compare("DistanceBatch.n", (byte*)&it.n - at, 8, 8);
      Compare("DistanceBatch.ld", (byte*)&it.ld - at, 16, 16);
      Compare("DistanceBatch.t", (byte*)&it.t - at, 24, 24);
      Compare("DistanceBatch.position", (byte*)&it.position - at, 32, 32);
      Compare("DistanceBatch.distance", (byte*)&it.distance - at, 40, 36);
      Compare("DistanceBatch.normal", (byte*)&it.normal - at, 48, 40);
      Compare("DistanceBatch.velocity", (byte*)&it.velocity - at, 56, 44);
    }

    static void CheckObstacleDesc() {
      var it = new ObstacleDesc();
      byte* at = (byte*)&it;
      Compare("ObstacleDesc", sizeof(ObstacleDesc), 296, 288);
      Compare("ObstacleDesc.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("ObstacleDesc.shape", (byte*)&it.shape - at, 4, 4);
      Compare("ObstacleDesc.motion", (byte*)&it.motion - at, 8, 8);
      Compare("ObstacleDesc.inside", (byte*)&it.inside - at, 12, 12);
      Compare("ObstacleDesc.size", (byte*)it.size - at, 16, 16);
      Compare("ObstacleDesc.position", (byte*)it.position - at, 40, 40);
      Compare("ObstacleDesc.orientation", (byte*)it.orientation - at, 64, 64);
      Compare("ObstacleDesc.velocity", (byte*)it.velocity - at, 96, 96);
      Compare("ObstacleDesc.angular_velocity", (byte*)it.angular_velocity - at, 120, 120);
      Compare("ObstacleDesc.mass", (byte*)&it.mass - at, 144, 144);
      Compare("ObstacleDesc.inertia", (byte*)it.inertia - at, 152, 152);
      Compare("ObstacleDesc.contact", (byte*)&it.contact - at, 224, 224);
      Compare("ObstacleDesc.distance", (byte*)&it.distance - at, 232, 228);
      Compare("ObstacleDesc.user", (byte*)&it.user - at, 240, 232);
      Compare("ObstacleDesc.lower", (byte*)it.lower - at, 248, 240);
      Compare("ObstacleDesc.upper", (byte*)it.upper - at, 272, 264);
    }

    static void CheckSurfaceDesc() {
      var it = new SurfaceDesc();
      byte* at = (byte*)&it;
      Compare("SurfaceDesc", sizeof(SurfaceDesc), 120, 120);
      Compare("SurfaceDesc.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("SurfaceDesc.body", (byte*)&it.body - at, 4, 4);
      Compare("SurfaceDesc.pressure", (byte*)&it.pressure - at, 8, 8);
      Compare("SurfaceDesc.traction", (byte*)it.traction - at, 16, 16);
      Compare("SurfaceDesc.dead_traction", (byte*)it.dead_traction - at, 40, 40);
      Compare("SurfaceDesc.max_spacing", (byte*)&it.max_spacing - at, 64, 64);
      Compare("SurfaceDesc.prescribes", (byte*)&it.prescribes - at, 72, 72);
      Compare("SurfaceDesc.reserved", (byte*)&it.reserved - at, 76, 76);
      Compare("SurfaceDesc.velocity", (byte*)it.velocity - at, 80, 80);
      Compare("SurfaceDesc.penalty", (byte*)&it.penalty - at, 104, 104);
      Compare("SurfaceDesc.modulus", (byte*)&it.modulus - at, 112, 112);
    }

    static void CheckMarkerBatch() {
      var it = new MarkerBatch();
      byte* at = (byte*)&it;
      Compare("MarkerBatch", sizeof(MarkerBatch), 88, 64);
      Compare("MarkerBatch.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("MarkerBatch.dim", (byte*)&it.dim - at, 4, 4);
      Compare("MarkerBatch.n", (byte*)&it.n - at, 8, 8);
      Compare("MarkerBatch.ld", (byte*)&it.ld - at, 16, 16);
      Compare("MarkerBatch.t", (byte*)&it.t - at, 24, 24);
      Compare("MarkerBatch.dt", (byte*)&it.dt - at, 32, 32);
      Compare("MarkerBatch.id", (byte*)&it.id - at, 40, 40);
      Compare("MarkerBatch.position", (byte*)&it.position - at, 48, 44);
      Compare("MarkerBatch.area", (byte*)&it.area - at, 56, 48);
      Compare("MarkerBatch.reference_area", (byte*)&it.reference_area - at, 64, 52);
      Compare("MarkerBatch.displacement", (byte*)&it.displacement - at, 72, 56);
      Compare("MarkerBatch.velocity", (byte*)&it.velocity - at, 80, 60);
    }

    static void CheckAdaptionBatch() {
      var it = new AdaptionBatch();
      byte* at = (byte*)&it;
      Compare("AdaptionBatch", sizeof(AdaptionBatch), 56, 48);
      Compare("AdaptionBatch.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("AdaptionBatch.what", (byte*)&it.what - at, 4, 4);
      Compare("AdaptionBatch.n", (byte*)&it.n - at, 8, 8);
      Compare("AdaptionBatch.ld", (byte*)&it.ld - at, 16, 16);
      Compare("AdaptionBatch.dim", (byte*)&it.dim - at, 24, 24);
      Compare("AdaptionBatch.reserved", (byte*)&it.reserved - at, 28, 28);
      Compare("AdaptionBatch.id", (byte*)&it.id - at, 32, 32);
      Compare("AdaptionBatch.other", (byte*)&it.other - at, 40, 36);
      Compare("AdaptionBatch.position", (byte*)&it.position - at, 48, 40);
    }

    static void CheckAdaptionDesc() {
      var it = new AdaptionDesc();
      byte* at = (byte*)&it;
      Compare("AdaptionDesc", sizeof(AdaptionDesc), 72, 64);
      Compare("AdaptionDesc.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("AdaptionDesc.every", (byte*)&it.every - at, 4, 4);
      Compare("AdaptionDesc.split_edge", (byte*)&it.split_edge - at, 8, 8);
      Compare("AdaptionDesc.least_edge", (byte*)&it.least_edge - at, 16, 16);
      Compare("AdaptionDesc.min_per_cell", (byte*)&it.min_per_cell - at, 24, 24);
      Compare("AdaptionDesc.max_per_cell", (byte*)&it.max_per_cell - at, 28, 28);
      Compare("AdaptionDesc.merge_distance", (byte*)&it.merge_distance - at, 32, 32);
      Compare("AdaptionDesc.merge_tolerance", (byte*)&it.merge_tolerance - at, 40, 40);
      Compare("AdaptionDesc.most_particles", (byte*)&it.most_particles - at, 48, 48);
      Compare("AdaptionDesc.accept", (byte*)&it.accept - at, 56, 56);
      Compare("AdaptionDesc.user", (byte*)&it.user - at, 64, 60);
    }

    static void CheckAdaptionInfo() {
      var it = new AdaptionInfo();
      byte* at = (byte*)&it;
      Compare("AdaptionInfo", sizeof(AdaptionInfo), 80, 80);
      Compare("AdaptionInfo.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("AdaptionInfo.reserved", (byte*)&it.reserved - at, 4, 4);
      Compare("AdaptionInfo.splits", (byte*)&it.splits - at, 8, 8);
      Compare("AdaptionInfo.added", (byte*)&it.added - at, 16, 16);
      Compare("AdaptionInfo.merges", (byte*)&it.merges - at, 24, 24);
      Compare("AdaptionInfo.kinetic_loss", (byte*)&it.kinetic_loss - at, 32, 32);
      Compare("AdaptionInfo.affine_loss", (byte*)&it.affine_loss - at, 40, 40);
      Compare("AdaptionInfo.strain_loss", (byte*)&it.strain_loss - at, 48, 48);
      Compare("AdaptionInfo.angular_momentum_loss", (byte*)it.angular_momentum_loss - at, 56, 56);
    }

    static void CheckHeatDesc() {
      var it = new HeatDesc();
      byte* at = (byte*)&it;
      Compare("HeatDesc", sizeof(HeatDesc), 64, 56);
      Compare("HeatDesc.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("HeatDesc.reserved", (byte*)&it.reserved - at, 4, 4);
      Compare("HeatDesc.specific_heat", (byte*)&it.specific_heat - at, 8, 8);
      Compare("HeatDesc.conductivity", (byte*)&it.conductivity - at, 16, 16);
      Compare("HeatDesc.expansion", (byte*)&it.expansion - at, 24, 24);
      Compare("HeatDesc.reference_temperature", (byte*)&it.reference_temperature - at, 32, 32);
      Compare("HeatDesc.dissipated_share", (byte*)&it.dissipated_share - at, 40, 40);
      Compare("HeatDesc.source", (byte*)&it.source - at, 48, 48);
      Compare("HeatDesc.user", (byte*)&it.user - at, 56, 52);
    }

    static void CheckHeatInfo() {
      var it = new HeatInfo();
      byte* at = (byte*)&it;
      Compare("HeatInfo", sizeof(HeatInfo), 176, 176);
      Compare("HeatInfo.struct_size", (byte*)&it.struct_size - at, 0, 0);
      Compare("HeatInfo.iterations", (byte*)&it.iterations - at, 4, 4);
      Compare("HeatInfo.heat", (byte*)&it.heat - at, 8, 8);
      Compare("HeatInfo.gained", (byte*)&it.gained - at, 16, 16);
      Compare("HeatInfo.walls", (byte*)it.walls - at, 24, 24);
      Compare("HeatInfo.sources", (byte*)&it.sources - at, 72, 72);
      Compare("HeatInfo.surfaces", (byte*)&it.surfaces - at, 80, 80);
      Compare("HeatInfo.dissipated", (byte*)&it.dissipated - at, 88, 88);
      Compare("HeatInfo.gained_total", (byte*)&it.gained_total - at, 96, 96);
      Compare("HeatInfo.walls_total", (byte*)it.walls_total - at, 104, 104);
      Compare("HeatInfo.sources_total", (byte*)&it.sources_total - at, 152, 152);
      Compare("HeatInfo.surfaces_total", (byte*)&it.surfaces_total - at, 160, 160);
      Compare("HeatInfo.dissipated_total", (byte*)&it.dissipated_total - at, 168, 168);
    }

    public static int Check() {
      wrong = 0;
      CheckParam();
      CheckView();
      CheckMessage();
      CheckTransport();
      CheckBalanceDesc();
      CheckParallelInfo();
      CheckContextDesc();
      CheckGridDesc();
      CheckMaterialBatch();
      CheckMaterialDesc();
      CheckOperatorInfo();
      CheckStepperDesc();
      CheckStepInfo();
      CheckParticleBatch();
      CheckNodeBatch();
      CheckAdvanceDesc();
      CheckProfile();
      CheckContactDesc();
      CheckContactInfo();
      CheckContactBatch();
      CheckDistanceBatch();
      CheckObstacleDesc();
      CheckSurfaceDesc();
      CheckMarkerBatch();
      CheckAdaptionBatch();
      CheckAdaptionDesc();
      CheckAdaptionInfo();
      CheckHeatDesc();
      CheckHeatInfo();
      foreach (var method in typeof(Native).GetMethods())
        if (method.IsStatic) Marshal.Prelink(method);
      return wrong;
    }
  }
}
