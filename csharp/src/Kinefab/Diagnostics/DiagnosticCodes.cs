namespace Kinefab.Diagnostics;

/// <summary>The codes of schemas/diagnostics.json that this library reports; their meaning stands there.</summary>
public static class DiagnosticCodes
{
    /// <summary>The JSON is broken: {detail}.</summary>
    public const string JsonSyntax = "JSON_SYNTAX";

    /// <summary>The text is not UTF-8 from here on.</summary>
    public const string JsonNotUtf8 = "JSON_NOT_UTF8";

    /// <summary>A string holds half of a surrogate pair.</summary>
    public const string JsonStringInvalid = "JSON_STRING_INVALID";

    /// <summary>Objects and arrays lie more than {limit} deep in each other.</summary>
    public const string JsonTooDeep = "JSON_TOO_DEEP";

    /// <summary>The file holds no data.</summary>
    public const string SceneEmpty = "SCENE_EMPTY";

    /// <summary>{path} cannot be read: {detail}.</summary>
    public const string SourceUnreadable = "SOURCE_UNREADABLE";

    /// <summary>{path} is a folder.</summary>
    public const string SourceIsFolder = "SOURCE_IS_FOLDER";

    /// <summary>There is no scene file {path}.</summary>
    public const string SceneNotFound = "SCENE_NOT_FOUND";

    /// <summary>The scene has {size} bytes or more; at most {limit} are read.</summary>
    public const string SceneTooLarge = "SCENE_TOO_LARGE";

    /// <summary>An array has more than {limit} items.</summary>
    public const string ItemsTooMany = "ITEMS_TOO_MANY";

    /// <summary>{count} more findings are not listed.</summary>
    public const string FindingsOmitted = "FINDINGS_OMITTED";

    /// <summary>The binary scene file is damaged: {detail}.</summary>
    public const string ContainerInvalid = "CONTAINER_INVALID";

    /// <summary>The binary scene file is of version {version}; this library reads version 1.</summary>
    public const string ContainerVersionUnsupported = "CONTAINER_VERSION_UNSUPPORTED";

    /// <summary>The file has nothing of what every scene has: format, version, gameObjects.</summary>
    public const string FormatMissing = "FORMAT_MISSING";

    /// <summary>The format is "{format}", not "kinefab.scene".</summary>
    public const string FormatUnknown = "FORMAT_UNKNOWN";

    /// <summary>The version "{version}" is not of the form major.minor.</summary>
    public const string VersionInvalid = "VERSION_INVALID";

    /// <summary>Version {version} of the format cannot be read; this library reads 1.x.</summary>
    public const string VersionUnsupported = "VERSION_UNSUPPORTED";

    /// <summary>Version {version} of the format is newer than this library, which knows 1.0.</summary>
    public const string VersionNewer = "VERSION_NEWER";

    /// <summary>The field "{field}" is missing.</summary>
    public const string FieldMissing = "FIELD_MISSING";

    /// <summary>The field "{field}" is unknown.</summary>
    public const string FieldUnknown = "FIELD_UNKNOWN";

    /// <summary>The field "{field}" stands here twice.</summary>
    public const string FieldDuplicate = "FIELD_DUPLICATE";

    /// <summary>There is {found} where {expected} belongs.</summary>
    public const string TypeMismatch = "TYPE_MISMATCH";

    /// <summary>"{value}" is none of: {allowed}.</summary>
    public const string ValueNotAllowed = "VALUE_NOT_ALLOWED";

    /// <summary>"{value}" stands in the list twice.</summary>
    public const string ItemDuplicate = "ITEM_DUPLICATE";

    /// <summary>The array has {found} items, not {expected}.</summary>
    public const string ArrayLength = "ARRAY_LENGTH";

    /// <summary>There is no component of type "{type}" in a scene.</summary>
    public const string ComponentTypeUnknown = "COMPONENT_TYPE_UNKNOWN";

    /// <summary>The id is empty.</summary>
    public const string IdEmpty = "ID_EMPTY";

    /// <summary>The id "{id}" belongs to gameObjects[{first}] already.</summary>
    public const string IdDuplicate = "ID_DUPLICATE";

    /// <summary>The parent {parent} does not stand before gameObjects[{index}].</summary>
    public const string ParentNotEarlier = "PARENT_NOT_EARLIER";

    /// <summary>There is no {list}[{index}]; the list has {count}.</summary>
    public const string ReferenceUnresolved = "REFERENCE_UNRESOLVED";

    /// <summary>The GameObject has more than one Rigidbody.</summary>
    public const string RigidbodyDuplicate = "RIGIDBODY_DUPLICATE";

    /// <summary>The GameObject has more than one {type}.</summary>
    public const string ComponentDuplicate = "COMPONENT_DUPLICATE";

    /// <summary>The joint's GameObject has no Rigidbody.</summary>
    public const string JointWithoutRigidbody = "JOINT_WITHOUT_RIGIDBODY";

    /// <summary>The connected gameObjects[{gameObject}] has no Rigidbody.</summary>
    public const string ConnectedBodyWithoutRigidbody = "CONNECTED_BODY_WITHOUT_RIGIDBODY";

    /// <summary>The ArticulationBody stands below the Rigidbody of {object}.</summary>
    public const string LinkBelowRigidbody = "LINK_BELOW_RIGIDBODY";

    /// <summary>The GameObject has an ArticulationBody and a Rigidbody.</summary>
    public const string LinkAndRigidbody = "LINK_AND_RIGIDBODY";

    /// <summary>The joint connects its own GameObject with itself.</summary>
    public const string JointConnectsItself = "JOINT_CONNECTS_ITSELF";

    /// <summary>components[{component}] is not a joint.</summary>
    public const string CouplingNotAJoint = "COUPLING_NOT_A_JOINT";

    /// <summary>The joint has no coordinate "{coordinate}".</summary>
    public const string CouplingCoordinateMissing = "COUPLING_COORDINATE_MISSING";

    /// <summary>The coupling couples a coordinate with itself.</summary>
    public const string CouplingItself = "COUPLING_ITSELF";

    /// <summary>gameObjects[{first}] stands for the ground already.</summary>
    public const string GroundTwice = "GROUND_TWICE";

    /// <summary>The site has components, or no GameObject above it.</summary>
    public const string SiteNotAFrame = "SITE_NOT_A_FRAME";

    /// <summary>The pair that passes through each other is one GameObject twice.</summary>
    public const string IgnoredCollisionItself = "IGNORED_COLLISION_ITSELF";

    /// <summary>The coupling has two terms of one coordinate.</summary>
    public const string CouplingTermTwice = "COUPLING_TERM_TWICE";

    /// <summary>The coupling says twice what it follows: by 'terms' and by 'a' or 'ratio'.</summary>
    public const string CouplingTermsBeside = "COUPLING_TERMS_BESIDE";

    /// <summary>The track has {keys} keys, the clip {times} times.</summary>
    public const string AnimationKeyCount = "ANIMATION_KEY_COUNT";

    /// <summary>{number} is not a finite number.</summary>
    public const string NumberNotFinite = "NUMBER_NOT_FINITE";

    /// <summary>{number} is 0 as a 32-bit float, and Unity computes in those.</summary>
    public const string NumberBelowFloat32 = "NUMBER_BELOW_FLOAT32";

    /// <summary>{number} is beyond the largest 32-bit float, and Unity computes in those.</summary>
    public const string NumberBeyondFloat32 = "NUMBER_BEYOND_FLOAT32";

    /// <summary>{value} is not {range}.</summary>
    public const string NumberOutOfRange = "NUMBER_OUT_OF_RANGE";

    /// <summary>The rotation has length {length}, not 1.</summary>
    public const string QuaternionNotUnit = "QUATERNION_NOT_UNIT";

    /// <summary>This is not a SHA-256: 64 lower-case hexadecimal digits.</summary>
    public const string Sha256Invalid = "SHA256_INVALID";

    /// <summary>The mass is {mass} kg.</summary>
    public const string BodyMassNotPositive = "BODY_MASS_NOT_POSITIVE";

    /// <summary>The inertia tensor is {inertia}.</summary>
    public const string BodyInertiaNotPositive = "BODY_INERTIA_NOT_POSITIVE";

    /// <summary>No body has the moments of inertia {inertia}: one exceeds the sum of the others.</summary>
    public const string BodyInertiaTriangle = "BODY_INERTIA_TRIANGLE";

    /// <summary>The axis is zero.</summary>
    public const string JointAxisZero = "JOINT_AXIS_ZERO";

    /// <summary>The secondary axis is zero or lies along the axis.</summary>
    public const string JointSecondaryAxisParallel = "JOINT_SECONDARY_AXIS_PARALLEL";

    /// <summary>The lower limit {min} is above the upper one {max}.</summary>
    public const string HingeLimitsOrder = "HINGE_LIMITS_ORDER";

    /// <summary>The lower limit {lower} is above the upper one {upper}.</summary>
    public const string LinkLimitsOrder = "LINK_LIMITS_ORDER";

    /// <summary>lowAngularXLimit {low} is above highAngularXLimit {high}.</summary>
    public const string AngularXLimitsOrder = "ANGULAR_X_LIMITS_ORDER";

    /// <summary>The limit {limit} acts on both sides of zero, so it cannot be negative.</summary>
    public const string LimitNegative = "LIMIT_NEGATIVE";

    /// <summary>{count} indices do not make triangles.</summary>
    public const string SubmeshNotTriangles = "SUBMESH_NOT_TRIANGLES";

    /// <summary>The submesh starts at index {start}, not at {expected}, where the one before ends.</summary>
    public const string SubmeshGap = "SUBMESH_GAP";

    /// <summary>The times do not rise here.</summary>
    public const string AnimationTimesNotRising = "ANIMATION_TIMES_NOT_RISING";

    /// <summary>"{uri}" could lead out of the scene's folder.</summary>
    public const string BufferUriUnsafe = "BUFFER_URI_UNSAFE";

    /// <summary>The image does not begin as {mediaType} does.</summary>
    public const string ImageNotOfKind = "IMAGE_NOT_OF_KIND";

    /// <summary>The buffer {uri} cannot be read: {detail}.</summary>
    public const string BufferMissing = "BUFFER_MISSING";

    /// <summary>The buffer has {found} bytes, not {expected}.</summary>
    public const string BufferSize = "BUFFER_SIZE";

    /// <summary>{uri} is not the buffer that this scene was written with.</summary>
    public const string BufferSha256 = "BUFFER_SHA256";

    /// <summary>The offset {offset} is not a multiple of 4 from 0.</summary>
    public const string BufferMisaligned = "BUFFER_MISALIGNED";

    /// <summary>The values end at byte {end}, the buffer at {length}.</summary>
    public const string BufferOverrun = "BUFFER_OVERRUN";

    /// <summary>The triangles use vertex {index}; there are {count}.</summary>
    public const string MeshIndexRange = "MESH_INDEX_RANGE";

    /// <summary>Vertex {vertex} has a coordinate that is not a finite number.</summary>
    public const string MeshPositionNotFinite = "MESH_POSITION_NOT_FINITE";

    /// <summary>The scale {scale} makes the object vanish.</summary>
    public const string TransformScaleZero = "TRANSFORM_SCALE_ZERO";

    /// <summary>The object is turned under a parent of uneven scale {scale}: Unity shears it, its joints and colliders stay as they are.</summary>
    public const string TransformSkew = "TRANSFORM_SKEW";

    /// <summary>Unity does not support the negative size {size}.</summary>
    public const string ColliderSizeNegative = "COLLIDER_SIZE_NEGATIVE";

    /// <summary>Unity ignores a MeshCollider that is not convex on a Rigidbody that is not kinematic.</summary>
    public const string MeshColliderNotConvex = "MESH_COLLIDER_NOT_CONVEX";

    /// <summary>The colliders of {a} and {b} overlap by {depth} m at the exported pose, and no joint keeps the two from colliding: Unity pushes them apart.</summary>
    public const string CollidersOverlap = "COLLIDERS_OVERLAP";

    /// <summary>Whether colliders overlap at the exported pose was not checked: {detail}.</summary>
    public const string OverlapsNotChecked = "OVERLAPS_NOT_CHECKED";

    /// <summary>There are {materials} materials for {submeshes} submeshes.</summary>
    public const string RendererMaterialCount = "RENDERER_MATERIAL_COUNT";

    /// <summary>The joint moves nothing: neither side is a Rigidbody that the solver moves.</summary>
    public const string JointBetweenKinematic = "JOINT_BETWEEN_KINEMATIC";

    /// <summary>Unity recomputes connectedAnchor, because autoConfigureConnectedAnchor is on: this value is lost.</summary>
    public const string ConnectedAnchorRecomputed = "CONNECTED_ANCHOR_RECOMPUTED";

    /// <summary>At start-up the anchors stand {gap} m further apart than the joint allows: Unity pulls the bodies together with a jerk.</summary>
    public const string JointAnchorsApart = "JOINT_ANCHORS_APART";

    /// <summary>Both limits are {angle} degrees: Unity locks the hinge at 0 instead.</summary>
    public const string HingeLimitsEqual = "HINGE_LIMITS_EQUAL";

    /// <summary>A limit of {angle} degrees is cut to 180, where the hinge may turn past it: its angle wraps there.</summary>
    public const string HingeLimitsBeyond180 = "HINGE_LIMITS_BEYOND_180";

    /// <summary>The stop at {angle} degrees is so near a half turn that the hinge may turn past it: its angle wraps there.</summary>
    public const string HingeLimitsWrap = "HINGE_LIMITS_WRAP";

    /// <summary>A limit of {angle} degrees is more than extendedLimits reach.</summary>
    public const string HingeLimitsBeyond360 = "HINGE_LIMITS_BEYOND_360";

    /// <summary>The motor switches the spring off.</summary>
    public const string HingeMotorOverridesSpring = "HINGE_MOTOR_OVERRIDES_SPRING";

    /// <summary>The motor's force is 0, so it does nothing.</summary>
    public const string HingeMotorForceZero = "HINGE_MOTOR_FORCE_ZERO";

    /// <summary>A limit of {angle} degrees is never reached: angles are measured within a half turn.</summary>
    public const string AngularLimitBeyond180 = "ANGULAR_LIMIT_BEYOND_180";

    /// <summary>The stop at {angle} degrees is so near a half turn that the joint may turn past it: its angle wraps there.</summary>
    public const string AngularLimitWraps = "ANGULAR_LIMIT_WRAPS";

    /// <summary>A swing limit of {angle} degrees beside a free swing is never reached: the joint's X rises to 90 degrees at most.</summary>
    public const string SwingLimitBeyond90 = "SWING_LIMIT_BEYOND_90";

    /// <summary>The freedom is Limited, but its limit leaves no room.</summary>
    public const string LimitWithoutRoom = "LIMIT_WITHOUT_ROOM";

    /// <summary>A soft limit does not bounce.</summary>
    public const string LimitBounceIgnored = "LIMIT_BOUNCE_IGNORED";

    /// <summary>{field} {ignored} is not used: the joint has one for both limits, {used} of {other}.</summary>
    public const string LimitResponseShared = "LIMIT_RESPONSE_SHARED";

    /// <summary>The damper makes the limit soft, and without a spring nothing pushes back.</summary>
    public const string LimitDamperWithoutSpring = "LIMIT_DAMPER_WITHOUT_SPRING";

    /// <summary>The Slerp drive does nothing, because an angular axis is locked.</summary>
    public const string SlerpDriveLocked = "SLERP_DRIVE_LOCKED";

    /// <summary>The drive does nothing in rotationDriveMode {mode}.</summary>
    public const string DriveOfOtherMode = "DRIVE_OF_OTHER_MODE";

    /// <summary>The drive does nothing, because its axis is locked.</summary>
    public const string DriveOnLockedFreedom = "DRIVE_ON_LOCKED_FREEDOM";

    /// <summary>One axis alone of the spherical joint is limited, which Unity refuses.</summary>
    public const string LinkSphericalOneLimited = "LINK_SPHERICAL_ONE_LIMITED";

    /// <summary>The link is immovable, but not the root of its articulation, so Unity moves it all the same.</summary>
    public const string LinkImmovableNotRoot = "LINK_IMMOVABLE_NOT_ROOT";

    /// <summary>The two anchors of the link are {distance} m and {angle} degrees apart, and the first step snaps the link there.</summary>
    public const string LinkAnchorsApart = "LINK_ANCHORS_APART";

    /// <summary>maximumForce is 0, so the drive does nothing.</summary>
    public const string DriveMaximumForceZero = "DRIVE_MAXIMUM_FORCE_ZERO";

    /// <summary>The coordinate "{coordinate}" is locked, so the coupling holds the other one still.</summary>
    public const string CouplingCoordinateLocked = "COUPLING_COORDINATE_LOCKED";

    /// <summary>The source states what neither solver follows and no joint of Unity's has.</summary>
    public const string JointStatedUnfollowed = "JOINT_STATED_UNFOLLOWED";

    /// <summary>{what} is {stated} in the file, counted from the source's constraints, and {counted} counted from the joints.</summary>
    public const string MobilityDiffers = "MOBILITY_DIFFERS";

    /// <summary>
    /// {what} is {stated} in the file, counted from the source's constraints, and {counted} counted from the joints, which hold a motion by
    /// so little that either may be meant.
    /// </summary>
    public const string MobilityUnsure = "MOBILITY_UNSURE";

    /// <summary>First-order mobility at the exported pose is {stated} in the file and {counted} counted from the joints.</summary>
    public const string MobilityFirstOrderDiffers = "MOBILITY_FIRST_ORDER_DIFFERS";

    /// <summary>The loop through {joints} does not move as its joints stand: its axes are off by a small angle, which locks it. The solvers let the locked angles give, as Unity does.</summary>
    public const string LoopInconsistent = "LOOP_INCONSISTENT";

    /// <summary>No pose of the mechanism satisfies the limits of {joints} and its other joints at once, from {time} s; each is held where it stands.</summary>
    public const string LimitsContradict = "LIMITS_CONTRADICT";

    /// <summary>The drive of a joint has no limit of force, and the rest of the mechanism does not let it move as it is asked, from {time} s: {joints}. It stalls there.</summary>
    public const string DriveStalled = "DRIVE_STALLED";

    /// <summary>{coordinate} is to go to {target}, and its own limits end at {limit}.</summary>
    public const string DriveBeyondLimits = "DRIVE_BEYOND_LIMITS";

    /// <summary>{coordinate} is driven {how}, and by the same drive, the joint's slerp drive, {other} too: its {lost} is given up.</summary>
    public const string DriveShared = "DRIVE_SHARED";

    /// <summary>{coordinate} is to turn at {speed}, which is {angle} degrees in a step of {step} s: from 180 on no step tells which way it turns.</summary>
    public const string DriveSpeedCoarse = "DRIVE_SPEED_COARSE";

    /// <summary>The exact solver found no motion of the mechanism of {object} in a part of the step from {time} s: {reason}. The mechanism stands still in that part, and its speeds fall.</summary>
    public const string StepUnsolved = "STEP_UNSOLVED";

    /// <summary>The mechanism of {object} stood open by {gap} there at {time} s. The exact solver moved its bodies by up to {distance} and turned them by up to {turn} to close it, without giving them speed.</summary>
    public const string StartClosed = "START_CLOSED";

    /// <summary>The mechanism of {object} had speeds at {time} s that its joints forbid, {speed} at this one. The exact solver took them off at once, which gives no energy.</summary>
    public const string StartSpeedForbidden = "START_SPEED_FORBIDDEN";

    /// <summary>The exact solver takes the bodies' own masses, not massScale {own} and connectedMassScale {connected}.</summary>
    public const string MassScaleIgnored = "MASS_SCALE_IGNORED";

    /// <summary>The exact solver leaves out {what} of the link {object}.</summary>
    public const string LinkNotExact = "LINK_NOT_EXACT";

    /// <summary>The recording {path} cannot be read: {detail}.</summary>
    public const string RecordingUnreadable = "RECORDING_UNREADABLE";

    /// <summary>The recording {path} is of version {version}, this tool knows {known}.</summary>
    public const string RecordingVersionUnknown = "RECORDING_VERSION_UNKNOWN";

    /// <summary>{path} is the recording of another scene than {scene}, or of an earlier state of the file: its bytes differ.</summary>
    public const string RecordingOtherScene = "RECORDING_OTHER_SCENE";

    /// <summary>{where} is the first that differs from the recording {path}.</summary>
    public const string RecordingDiffers = "RECORDING_DIFFERS";

    /// <summary>The {joint} comes apart by {measure} within {seconds} s in Unity's solver{others}.</summary>
    public const string AdviceJointDrifts = "ADVICE_JOINT_DRIFTS";

    /// <summary>In Unity's solver {body} comes to stand {measure} from where the mechanism truly moves it within {seconds} s.</summary>
    public const string AdviceMotionDiffers = "ADVICE_MOTION_DIFFERS";

    /// <summary>The {joint} shakes by {measure} from step to step in Unity's solver; the true motion does not.</summary>
    public const string AdviceJointShakes = "ADVICE_JOINT_SHAKES";

    /// <summary>The {drive} of the {joint} cannot hold the exported pose with {force}: it sinks by {measure} within {seconds} s{others}.</summary>
    public const string AdviceDriveWeak = "ADVICE_DRIVE_WEAK";

    /// <summary>The {drive} of the {joint} goes on swinging by {measure} to both sides, {period} s or {steps} steps a swing.</summary>
    public const string AdviceDriveRings = "ADVICE_DRIVE_RINGS";

    /// <summary>The {joint} ties {light} to {heavy}, 1:{ratio}; joints of its mechanism come apart by {measure}.</summary>
    public const string AdviceMassesUnlike = "ADVICE_MASSES_UNLIKE";

    /// <summary>Hung up at a joint, {body} would be turned by its weight by {turn} rad within one step, so thin is its inertia; joints of its mechanism come apart by {measure}.</summary>
    public const string AdviceInertiaThin = "ADVICE_INERTIA_THIN";

    /// <summary>The loop holds {count} of the {rows} locked freedoms of the {joint} already{others}; joints of its mechanism come apart by {measure}.</summary>
    public const string AdviceLoopOverConstrained = "ADVICE_LOOP_OVERCONSTRAINED";

    /// <summary>The {joint} has a range of {range} degrees{others}; Unity's solver goes {measure} beyond it.</summary>
    public const string AdviceLimitNarrow = "ADVICE_LIMIT_NARROW";

    /// <summary>The {solver} solver cannot follow the scene: its motion leaves the range of numbers.</summary>
    public const string AdviceCannotFollow = "ADVICE_CANNOT_FOLLOW";

    /// <summary>Only {seconds} s were simulated: the scene is large.</summary>
    public const string AdviceRunShortened = "ADVICE_RUN_SHORTENED";

    /// <summary>The scene has {count} joints; its loops were not looked at.</summary>
    public const string AdviceLoopsUncounted = "ADVICE_LOOPS_UNCOUNTED";

    /// <summary>{count} rows of joints in loops were neither locked nor freed on trial: the scene is large.</summary>
    public const string AdviceRowsUntried = "ADVICE_ROWS_UNTRIED";

    /// <summary>Only {count} changes were tried: the scene is large or the limit is low.</summary>
    public const string AdviceTrialsSpent = "ADVICE_TRIALS_SPENT";

    /// <summary>Coupling {coupling} needs joint {joint}, which has no component with that freedom.</summary>
    public const string CouplingWithoutJoint = "COUPLING_WITHOUT_JOINT";

    /// <summary>Joint {joint} is switched off, and {target} has no place for such a joint; it is left out.</summary>
    public const string JointDisabledDropped = "JOINT_DISABLED_DROPPED";

    /// <summary>Joint {joint} has a dry friction of {value}; it is the link's jointFriction, a coefficient that grows with the joint's load.</summary>
    public const string JointFrictionCoefficient = "JOINT_FRICTION_COEFFICIENT";

    /// <summary>Joint {joint} has an armature of {value} on {freedom}; Unity's joints have none.</summary>
    public const string JointArmatureDropped = "JOINT_ARMATURE_DROPPED";

    /// <summary>Joint {joint} states a largest {limits} of {freedom} and no drive that keeps to it.</summary>
    public const string JointEffortDropped = "JOINT_EFFORT_DROPPED";

    /// <summary>{target} has no place for {field} of {feature}.</summary>
    public const string TargetFieldDropped = "TARGET_FIELD_DROPPED";

    /// <summary>The {feature} is not quite kept in {target}: {detail}.</summary>
    public const string TargetFeatureApproximated = "TARGET_FEATURE_APPROXIMATED";

    /// <summary>Joint {joint} cannot be one of an articulation: {detail}.</summary>
    public const string ArticulationImpossible = "ARTICULATION_IMPOSSIBLE";

    /// <summary>Joint {joint} closes a loop; it is on the body {object}, which is fixed to its link.</summary>
    public const string ArticulationLoopHelper = "ARTICULATION_LOOP_HELPER";

    /// <summary>The articulation that begins with {object} has {count} links; PhysX 4.1, on which Unity's articulations are built, has room for 64.</summary>
    public const string ArticulationLinksMany = "ARTICULATION_LINKS_MANY";

    /// <summary>Unity moves convex shapes only; {collider} is the convex hull of its mesh.</summary>
    public const string ColliderMeshAsHull = "COLLIDER_MESH_AS_HULL";

    /// <summary>The mesh of {collider} is flat and has no convex hull; the box about it collides.</summary>
    public const string ColliderFlatAsBox = "COLLIDER_FLAT_AS_BOX";
}
