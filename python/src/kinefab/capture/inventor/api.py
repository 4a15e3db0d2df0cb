"""The members of Inventor's API that the capture uses, and no others.

Behind each: unit | frame | page of the Inventor API help (2019 to 2025) that states it.  Inventor counts in centimetres,
radians and kilograms whatever the document's units.  Out parameters come back as the answer, in their order.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

# fmt: off


class Application(Protocol):
    SoftwareVersion: SoftwareVersion  # - | - | Application.SoftwareVersion Property
    ActiveDocument: Document | None  # - | - | Application.ActiveDocument Property
    TransientObjects: TransientObjects  # - | - | Application.TransientObjects Property


class TransientObjects(Protocol):
    def CreateNameValueMap(self) -> NameValueMap: ...  # - | - | TransientObjects.CreateNameValueMap Method


class NameValueMap(Protocol):
    """Options; none are set."""


class SoftwareVersion(Protocol):
    Major: int  # number | - | SoftwareVersion.Major Property
    DisplayVersion: str  # text | - | SoftwareVersion.DisplayVersion Property


class Document(Protocol):
    DocumentType: int  # DocumentTypeEnum | - | Document.DocumentType Property
    FullFileName: str  # text | - | Document.FullFileName Property
    DisplayName: str  # text | - | Document.DisplayName Property
    RequiresUpdate: bool  # flag | - | Document.RequiresUpdate Property
    Dirty: bool  # flag | - | Document.Dirty Property
    ComponentDefinition: Definition  # - | - | AssemblyDocument.ComponentDefinition Property
    ActiveMaterial: Asset | None  # - | - | PartDocument.ActiveMaterial Property


class Collection(Protocol):
    Count: int  # number | - | ComponentOccurrences.Count Property

    def Item(self, Index: int) -> Any: ...  # from 1 | - | ComponentOccurrences.Item Property


class ModelStates(Protocol):
    Count: int  # number | - | ModelStates.Count Property
    ActiveModelState: ModelState  # - | - | ModelStates.ActiveModelState Property


class ModelState(Protocol):
    Name: str  # text | - | ModelState.Name Property


class Definition(Protocol):
    Document: Document  # - | - | ComponentDefinition.Document Property
    Occurrences: Collection  # - | - | AssemblyComponentDefinition.Occurrences Property
    Constraints: Collection  # - | the definition's own | AssemblyComponentDefinition.Constraints Property
    Joints: Collection  # - | the definition's own | AssemblyComponentDefinition.Joints Property
    OccurrencePatterns: Collection  # - | - | AssemblyComponentDefinition.OccurrencePatterns Property
    ModelStates: ModelStates  # - | - | AssemblyComponentDefinition.ModelStates Property
    SurfaceBodies: Collection  # - | part | PartComponentDefinition.SurfaceBodies Property
    AppearanceOverridesObjects: Collection  # faces, features, work surfaces, bodies | - | PartComponentDefinition.AppearanceOverridesObjects Property
    MassProperties: MassProperties | None  # - | part | PartComponentDefinition.MassProperties Property

    def RigidBodyAnalysis(self, Options: NameValueMap) -> RigidBodyResults: ...  # - | - | AssemblyComponentDefinition.RigidBodyAnalysis Method


class OccurrencePattern(Protocol):
    Name: str  # text | - | OccurrencePattern.Name Property
    OccurrencePatternElements: Collection  # the first holds what is repeated | - | OccurrencePattern.OccurrencePatternElements Property


class PatternElement(Protocol):
    Occurrences: Collection  # - | - | OccurrencePatternElement.Occurrences Property
    Suppressed: bool  # flag | - | OccurrencePatternElement.Suppressed Property
    Independent: bool  # flag | - | OccurrencePatternElement.Independent Property


class RigidBodyResults(Protocol):
    RigidBodyGroups: Collection  # - | - | RigidBodyResults.RigidBodyGroups Property
    RigidBodyJoints: Collection  # - | - | RigidBodyResults.RigidBodyJoints Property


class RigidBodyGroup(Protocol):
    Occurrences: Collection  # - | - | RigidBodyGroup.Occurrences Property
    Grounded: bool  # flag | - | RigidBodyGroup.Grounded Property
    GroupID: int  # number | - | RigidBodyGroup.GroupID Property


class RigidBodyJoint(Protocol):
    JointType: int  # RigidBodyJointTypeEnum | - | RigidBodyJoint.JointType Property
    GroupOne: RigidBodyGroup  # - | - | RigidBodyJoint.GroupOne Property
    GroupTwo: RigidBodyGroup  # - | - | RigidBodyJoint.GroupTwo Property


class Occurrence(Protocol):
    Name: str  # text | - | ComponentOccurrence.Name Property
    ParentOccurrence: Occurrence | None  # - | - | ComponentOccurrence.ParentOccurrence Property
    SubOccurrences: Collection  # - | root | ComponentOccurrence.SubOccurrences Property
    Definition: Definition  # - | - | ComponentOccurrence.Definition Property
    DefinitionDocumentType: int  # DocumentTypeEnum | - | ComponentOccurrence.DefinitionDocumentType Property
    Transformation: Matrix  # - | root | ComponentOccurrence.Transformation Property
    Grounded: bool  # flag | - | ComponentOccurrence.Grounded Property
    Suppressed: bool  # flag | - | ComponentOccurrence.Suppressed Property
    Visible: bool  # flag | - | ComponentOccurrence.Visible Property
    Flexible: bool  # flag | - | ComponentOccurrence.Flexible Property
    Adaptive: bool  # flag | - | ComponentOccurrence.Adaptive Property
    IsPatternElement: bool  # flag | - | ComponentOccurrence.IsPatternElement Property

    def GetDegreesOfFreedom(self) -> Sequence[Any]: ...  # count, vectors, count, vectors, cm | root | ComponentOccurrence.GetDegreesOfFreedom Method


class Matrix(Protocol):
    def GetMatrixData(self) -> Sequence[float]: ...  # 16 numbers, cm, order not stated | root | Matrix.GetMatrixData Method
    def Cell(self, Row: int, Column: int) -> float: ...  # from 1, translation in column 4, cm | root | Matrix.Cell Property


class Point(Protocol):
    X: float  # cm | as its owner | Point.X Property
    Y: float  # cm | as its owner | Point.Y Property
    Z: float  # cm | as its owner | Point.Z Property


class Vector(Protocol):
    X: float  # unit vector | as its owner | UnitVector.X Property
    Y: float  # unit vector | as its owner | UnitVector.Y Property
    Z: float  # unit vector | as its owner | UnitVector.Z Property


class Plane(Protocol):
    RootPoint: Point  # - | as its owner | Plane.RootPoint Property
    Normal: Vector  # - | as its owner | Plane.Normal Property


class Line(Protocol):
    RootPoint: Point  # - | as its owner | Line.RootPoint Property
    Direction: Vector  # - | as its owner | Line.Direction Property


class Circle(Protocol):
    Center: Point  # - | as its owner | Circle.Center Property
    Normal: Vector  # - | as its owner | Circle.Normal Property
    Radius: float  # cm | - | Circle.Radius Property


class Cylinder(Protocol):
    BasePoint: Point  # - | as its owner | Cylinder.BasePoint Property
    AxisVector: Vector  # - | as its owner | Cylinder.AxisVector Property
    Radius: float  # cm | - | Cylinder.Radius Property


class Sphere(Protocol):
    CenterPoint: Point  # - | as its owner | Sphere.CenterPoint Property
    Radius: float  # cm | - | Sphere.Radius Property


class Entity(Protocol):
    Geometry: Any  # of a face or edge | assembly, of a proxy | FaceProxy.Geometry Property
    Plane: Plane  # of a work plane | assembly, of a proxy | WorkPlaneProxy.Plane Property
    Line: Line  # of a work axis | assembly, of a proxy | WorkAxisProxy.Line Property
    Point: Point  # of a work point or vertex | assembly, of a proxy | WorkPointProxy.Point Property
    ContainingOccurrence: Occurrence | None  # - | - | FaceProxy.ContainingOccurrence Property


class Parameter(Protocol):
    Value: float  # cm or rad, of a ratio a plain number | - | Parameter.Value Property


class Limits(Protocol):
    MinimumEnabled: bool  # flag | - | ConstraintLimits.MinimumEnabled Property
    Minimum: Parameter | None  # - | - | ConstraintLimits.Minimum Property
    MaximumEnabled: bool  # flag | - | ConstraintLimits.MaximumEnabled Property
    Maximum: Parameter | None  # - | - | ConstraintLimits.Maximum Property


class Constraint(Protocol):
    Name: str  # text | - | AssemblyConstraint.Name Property
    Type: int  # ObjectTypeEnum | - | AssemblyConstraint.Type Property
    Suppressed: bool  # flag | - | AssemblyConstraint.Suppressed Property
    HealthStatus: int  # HealthStatusEnum | - | AssemblyConstraint.HealthStatus Property
    OccurrenceOne: Occurrence | None  # - | - | AssemblyConstraint.OccurrenceOne Property
    OccurrenceTwo: Occurrence | None  # - | - | AssemblyConstraint.OccurrenceTwo Property
    EntityOne: Entity  # - | - | AssemblyConstraint.EntityOne Property
    EntityTwo: Entity  # - | - | AssemblyConstraint.EntityTwo Property
    GeometryOne: Any  # - | assembly, face side applied | MateConstraint.GeometryOne Property
    GeometryTwo: Any  # - | assembly, face side applied | MateConstraint.GeometryTwo Property
    ConstraintLimits: Limits | None  # - | - | MateConstraint.ConstraintLimits Property
    EntityOneInferredType: int  # InferredTypeEnum | - | MateConstraint.EntityOneInferredType Property
    EntityTwoInferredType: int  # InferredTypeEnum | - | MateConstraint.EntityTwoInferredType Property
    Offset: Parameter  # cm | - | MateConstraint.Offset Property
    SolutionType: int  # MateConstraintSolutionTypeEnum or AngleConstraintSolutionTypeEnum | - | AngleConstraint.SolutionType Property
    Distance: Parameter  # cm, of a motion cm a turn | - | InsertConstraint.Distance Property
    AxesOpposed: bool  # flag | - | InsertConstraint.AxesOpposed Property
    LockRotation: bool  # flag | - | InsertConstraint.LockRotation Property
    Angle: Parameter  # rad | - | AngleConstraint.Angle Property
    ReferenceVectorEntity: Entity | None  # - | - | AngleConstraint.ReferenceVectorEntity Property
    InsideTangency: bool  # flag | - | TangentConstraint.InsideTangency Property
    Ratio: Parameter  # plain number | - | RotateRotateConstraint.Ratio Property
    ForwardDirection: bool  # flag | - | RotateRotateConstraint.ForwardDirection Property
    SymmetryPlane: Entity  # - | - | AssemblySymmetryConstraint.SymmetryPlane Property
    NormalsOpposed: bool  # flag | - | AssemblySymmetryConstraint.NormalsOpposed Property


class Joint(Protocol):
    Name: str  # text | - | AssemblyJoint.Name Property
    Definition: JointDefinition  # - | - | AssemblyJoint.Definition Property
    OccurrenceOne: Occurrence | None  # - | - | AssemblyJoint.OccurrenceOne Property
    OccurrenceTwo: Occurrence | None  # - | - | AssemblyJoint.OccurrenceTwo Property
    Suppressed: bool  # flag | - | AssemblyJoint.Suppressed Property
    HealthStatus: int  # HealthStatusEnum | - | AssemblyJoint.HealthStatus Property
    Locked: bool  # flag | - | AssemblyJoint.Locked Property


class JointDefinition(Protocol):
    JointType: int  # AssemblyJointTypeEnum | - | AssemblyJointDefinition.JointType Property
    OriginOne: Intent  # - | - | AssemblyJointDefinition.OriginOne Property
    OriginTwo: Intent  # - | - | AssemblyJointDefinition.OriginTwo Property
    AlignmentOne: Entity | None  # - | - | AssemblyJointDefinition.AlignmentOne Property
    AlignmentTwo: Entity | None  # - | - | AssemblyJointDefinition.AlignmentTwo Property
    FlipOriginDirection: bool  # flag | - | AssemblyJointDefinition.FlipOriginDirection Property
    FlipAlignmentDirection: bool  # flag | - | AssemblyJointDefinition.FlipAlignmentDirection Property
    Gap: Parameter | None  # cm | - | AssemblyJointDefinition.Gap Property
    AngularPosition: Parameter | None  # rad, first against second | - | AssemblyJointDefinition.AngularPosition Property
    LinearPosition: Parameter | None  # cm, first against second | - | AssemblyJointDefinition.LinearPosition Property
    HasAngularPositionLimits: bool  # flag | - | AssemblyJointDefinition.HasAngularPositionLimits Property
    AngularPositionStartLimit: Parameter | None  # rad | - | AssemblyJointDefinition.AngularPositionStartLimit Property
    AngularPositionEndLimit: Parameter | None  # rad | - | AssemblyJointDefinition.AngularPositionEndLimit Property
    HasLinearPositionStartLimit: bool  # flag | - | AssemblyJointDefinition.HasLinearPositionStartLimit Property
    HasLinearPositionEndLimit: bool  # flag | - | AssemblyJointDefinition.HasLinearPositionEndLimit Property
    LinearPositionStartLimit: Parameter | None  # cm | - | AssemblyJointDefinition.LinearPositionStartLimit Property
    LinearPositionEndLimit: Parameter | None  # cm | - | AssemblyJointDefinition.LinearPositionEndLimit Property


class Intent(Protocol):
    Geometry: Entity  # - | - | GeometryIntent.Geometry Property
    Point: Point  # - | not stated | GeometryIntent.Point Property


class Body(Protocol):
    Name: str  # text | - | SurfaceBody.Name Property
    Appearance: Asset | None  # - | - | SurfaceBody.Appearance Property

    def CalculateFacets(self, Tolerance: float) -> Sequence[Any]: ...  # counts, cm, normals, corners from 1 | part | SurfaceBody.CalculateFacets Method


class Overridden(Protocol):
    Type: int  # ObjectTypeEnum | - | Face.Type Property


class Asset(Protocol):
    DisplayName: str  # text, in the user's language | - | Asset.DisplayName Property

    def Item(self, Index: str) -> AssetValue: ...  # by key name | - | Asset.Item Property


class AssetValue(Protocol):
    Value: Color  # - | - | ColorAssetValue.Value Property


class Color(Protocol):
    Red: int  # 0 to 255 | - | Color.Red Property
    Green: int  # 0 to 255 | - | Color.Green Property
    Blue: int  # 0 to 255 | - | Color.Blue Property
    Opacity: float  # 0 to 1 | - | Color.Opacity Property


class MassProperties(Protocol):
    Mass: float  # kg | - | MassProperties.Mass Property
    CenterOfMass: Point  # cm | part | MassProperties.CenterOfMass Property

    def XYZMomentsOfInertia(self) -> Sequence[float]: ...  # kg cm^2: xx yy zz xy yz xz | part | MassProperties.XYZMomentsOfInertia Method
    def PrincipalMomentsOfInertia(self) -> Sequence[float]: ...  # kg cm^2 | - | MassProperties.PrincipalMomentsOfInertia Method
