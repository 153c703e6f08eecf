#pragma once

#include <array>

/// The stable codes of everything that can be said about a user's file.  A code never changes its meaning.
namespace tactus::dsl {

struct Code {
  const char* id;
  const char* meaning;
};

namespace code {
// The file as text and as XML.
inline constexpr Code unreadable_file{"E001", "a file is missing or cannot be read"};
inline constexpr Code empty_file{"E002", "a file holds no element"};
inline constexpr Code not_xml{"E003", "the text is not well-formed XML"};
inline constexpr Code several_roots{"E004", "a file has more than one outermost element"};
inline constexpr Code not_utf8{"E005", "the text is not UTF-8"};
inline constexpr Code too_large{"E006", "a file, or all of a stack, is too large"};
// Grammar.
inline constexpr Code wrong_root{"E010", "the outermost element is not the expected one"};
inline constexpr Code unknown_element{"E011", "no element has this name"};
inline constexpr Code unknown_attribute{"E012", "the element has no such attribute"};
inline constexpr Code missing_attribute{"E013", "a required attribute is missing"};
inline constexpr Code bad_value{"E014", "a value is not of the attribute's type or out of its range"};
inline constexpr Code misplaced_element{"E015", "an element stands where it must not"};
inline constexpr Code missing_element{"E016", "a required element is missing"};
inline constexpr Code too_many_elements{"E017", "an element stands more often than it may"};
inline constexpr Code stray_text{"E018", "text stands between elements"};
inline constexpr Code wrong_format{"E019", "the format number is not one that this version reads"};
inline constexpr Code duplicate_name{"E020", "a name is given twice"};
inline constexpr Code level_order{"E021", "the priorities of the levels do not rise"};
inline constexpr Code attributes_clash{"E022", "attributes of an element exclude each other, or one needs another"};
// References.
inline constexpr Code unknown_link{"E030", "the robot has no such link or group of links"};
inline constexpr Code unknown_joint{"E031", "the robot has no such moving joint or group of joints"};
inline constexpr Code unknown_object{"E032", "the scene has no such object"};
inline constexpr Code unknown_port{"E033", "no signal or port has this name"};
inline constexpr Code wrong_port_type{"E034", "a port gives another type than the attribute takes"};
inline constexpr Code include_outside{"E041", "an include leads out of the folders that the user allows"};
inline constexpr Code wrong_port_unit{"E040", "a port gives another unit or number of values than the attribute takes"};
inline constexpr Code unknown_class{"E035", "no <defaults> class has this name"};
inline constexpr Code unknown_parameter{"E036", "no <parameter> has this name"};
inline constexpr Code unknown_back_end{"E037", "no back end has this name"};
inline constexpr Code unknown_option{"E038", "the chosen back end has no such option"};
inline constexpr Code reference_cycle{"E039", "includes, classes, carriers or signals refer to each other in a circle"};
// Robot and scene.
inline constexpr Code unknown_model{"E050", "the robot's model cannot be found"};
inline constexpr Code wrong_start{"E051", "the start has not one value for each joint"};
inline constexpr Code start_outside_limits{"E052", "the start is outside a joint's limits"};
inline constexpr Code carrier_not_upright{"E053", "an object stands on one whose top is not level"};
inline constexpr Code joint_not_for_stacks{"E054", "a joint follows another one or has several degrees of freedom"};
inline constexpr Code unfit_rate{"E055", "a tick is not a whole number of the plant's steps"};
inline constexpr Code immovable_body{"E056", "a fault acts on what no force moves"};
inline constexpr Code pair_never_touches{"E057", "two bodies of a pair can never touch"};
inline constexpr Code duplicate_pair{"E058", "the material of a pair of bodies is given twice"};
// Compiling.
inline constexpr Code lacking_ability{"E060", "the back end cannot honour what the stack asks for"};
inline constexpr Code refused_by_factory{"E061", "a task, a signal or a back end refuses its values"};
inline constexpr Code unfit_for_dynamics{"E062", "the robot cannot be simulated"};
inline constexpr Code plugin_failed{"E070", "a plugin cannot be loaded"};
// Robot files.
inline constexpr Code no_root_link{"E080", "no link of the robot is the root"};
inline constexpr Code several_root_links{"E081", "more than one link has no parent"};
inline constexpr Code kinematic_loop{"E082", "joints form a loop or share a child"};
inline constexpr Code unsupported_joint{"E083", "the type of a joint is not supported"};
inline constexpr Code reversed_limits{"E084", "a lower limit lies above its upper limit"};
inline constexpr Code refused_by_urdf{"E085", "liburdfdom refuses the file"};
inline constexpr Code bad_mimic{"E086", "a joint cannot follow the one that its mimic names"};
inline constexpr Code impossible_robot{"E087", "no robot can be as the numbers say"};
// Warnings.
inline constexpr Code no_inertia{"W001", "a moving link has no mass: kinematics only"};
inline constexpr Code bad_mass{"W002", "the mass of a link is not positive"};
inline constexpr Code bad_inertia{"W003", "a tensor is not that of a rigid body"};
inline constexpr Code shape_not_felt{"W004", "a collision shape is replaced or left out"};
inline constexpr Code urdf_remark{"W005", "liburdfdom passed over a part of the file"};
inline constexpr Code meaningless_part{"W006", "a joint of this type makes no use of a part of its description"};
inline constexpr Code forgotten_centre{"W007", "the centre of mass of a link was probably forgotten"};
inline constexpr Code unread_part{"W008", "nothing reads a part of a robot's description"};
inline constexpr Code lost_digits{"W009", "a robot far from the world's origin costs digits"};
inline constexpr Code unused_signal{"W010", "nothing reads a signal"};
inline constexpr Code dead_level{"W020", "a level can do nothing at the start"};
inline constexpr Code duplicate_rows{"W021", "two tasks of a level ask for the same directions"};
inline constexpr Code posture_above{"W022", "a task above other levels holds every joint"};
inline constexpr Code too_many_contacts{"W023", "more contacts are desired than the joints can hold"};
inline constexpr Code unstable_gains{"W024", "a task's gains are not stable at the stated rate"};
inline constexpr Code out_of_reach{"W025", "a place cannot be reached"};
inline constexpr Code unreachable_phase{"W026", "nothing leads to a phase"};
inline constexpr Code deprecated_part{"W011", "an element or attribute is deprecated"};
inline constexpr Code former_name{"W012", "an element or attribute has another name now"};
inline constexpr Code unknown_figure{"W013", "a target names no figure of the run"};
}  // namespace code

inline constexpr std::array all_codes{
    code::unreadable_file,    code::empty_file,         code::not_xml,          code::several_roots,
    code::not_utf8,           code::too_large,          code::wrong_root,         code::unknown_element,  code::unknown_attribute,
    code::missing_attribute,  code::bad_value,          code::misplaced_element, code::missing_element,
    code::too_many_elements,  code::stray_text,         code::wrong_format,     code::duplicate_name,
    code::level_order,        code::attributes_clash,   code::unknown_link,       code::unknown_joint,    code::unknown_object,
    code::unknown_port,       code::wrong_port_type,    code::wrong_port_unit,    code::include_outside,    code::unknown_class,    code::unknown_parameter,
    code::unknown_back_end,   code::unknown_option,     code::reference_cycle,  code::unknown_model,
    code::wrong_start,        code::start_outside_limits, code::carrier_not_upright, code::joint_not_for_stacks,
    code::unfit_rate,         code::immovable_body,     code::pair_never_touches, code::duplicate_pair,
    code::lacking_ability,
    code::refused_by_factory, code::unfit_for_dynamics, code::plugin_failed,    code::no_root_link,
    code::several_root_links, code::kinematic_loop,     code::unsupported_joint, code::reversed_limits,
    code::refused_by_urdf,    code::bad_mimic,          code::impossible_robot, code::no_inertia,
    code::bad_mass,           code::bad_inertia,        code::shape_not_felt,   code::urdf_remark,
    code::meaningless_part,   code::forgotten_centre,   code::unread_part,      code::lost_digits,
    code::unused_signal,      code::dead_level,         code::duplicate_rows,     code::posture_above,
    code::too_many_contacts,  code::unstable_gains,     code::out_of_reach,       code::unreachable_phase,
    code::deprecated_part,    code::former_name,        code::unknown_figure};

}  // namespace tactus::dsl
