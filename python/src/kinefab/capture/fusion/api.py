"""The members of Fusion's API that the capture uses, and no others.

Behind each: unit | frame | page of the Fusion API help (2025) that states it.  Fusion counts in centimetres, radians and
kilograms whatever the document's units.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

# fmt: off


class Application(Protocol):
    version: str  # text | - | Application.version Property
    activeDocument: Document | None  # - | - | Application.activeDocument Property
    activeProduct: Design | None  # - | - | Application.activeProduct Property


class Document(Protocol):
    name: str  # text | - | Document.name Property
    isSaved: bool  # flag | - | Document.isSaved Property
    isModified: bool  # flag | - | Document.isModified Property


class Design(Protocol):
    productType: str  # text, DesignProductType | - | Product.productType Property
    rootComponent: RootComponent  # - | - | Design.rootComponent Property
    contactSets: Collection  # - | - | Design.contactSets Property
    configurationTopTable: ConfigurationTable | None  # - | - | Design.configurationTopTable Property


class Collection(Protocol):
    count: int  # number | - | Occurrences.count Property

    def item(self, index: int) -> Any: ...  # from 0 | - | Occurrences.item Method


class ConfigurationTable(Protocol):
    rows: Collection  # - | - | ConfigurationTopTable.rows Property
    activeRow: ConfigurationRow  # - | - | ConfigurationTopTable.activeRow Property


class ConfigurationRow(Protocol):
    name: str  # text | - | ConfigurationRow.name Property


class RootComponent(Protocol):
    name: str  # text | - | Component.name Property
    bRepBodies: Collection  # - | root | Component.bRepBodies Property
    occurrences: Collection  # - | root | Component.occurrences Property
    allJoints: Sequence[Joint]  # array | root | Component.allJoints Property
    allAsBuiltJoints: Sequence[AsBuiltJoint]  # array | root | Component.allAsBuiltJoints Property
    allRigidGroups: Sequence[RigidGroup]  # array | root | Component.allRigidGroups Property
    allAssemblyConstraints: Sequence[AssemblyConstraint]  # array | root | Component.allAssemblyConstraints Property
    features: Features  # - | - | Component.features Property


class Features(Protocol):
    rectangularPatternFeatures: Collection  # - | - | Features.rectangularPatternFeatures Property
    circularPatternFeatures: Collection  # - | - | Features.circularPatternFeatures Property
    pathPatternFeatures: Collection  # - | - | Features.pathPatternFeatures Property
    mirrorFeatures: Collection  # - | - | Features.mirrorFeatures Property


class PatternFeature(Protocol):
    name: str  # text | - | RectangularPatternFeature.name Property
    patternElements: Collection  # - | - | RectangularPatternFeature.patternElements Property


class PatternElement(Protocol):
    occurrences: Sequence[Occurrence] | None  # of a pattern of occurrences | - | PatternElement.occurrences Property


class Component(Protocol):
    name: str  # text | - | Component.name Property
    id: str  # text | - | Component.id Property
    bRepBodies: Collection  # - | component | Component.bRepBodies Property
    features: Features  # of a component with children | - | Component.features Property

    def getPhysicalProperties(self, accuracy: int) -> PhysicalProperties | None: ...  # CalculationAccuracy | - | Component.getPhysicalProperties Method


class PhysicalProperties(Protocol):
    mass: float  # kg | - | PhysicalProperties.mass Property
    centerOfMass: Point  # - | component | PhysicalProperties.centerOfMass Property

    def getXYZMomentsOfInertia(self) -> Sequence[Any]: ...  # flag, kg cm^2 about the origin: xx yy zz xy yz xz | component | PhysicalProperties.getXYZMomentsOfInertia Method
    def getPrincipalMomentsOfInertia(self) -> Sequence[Any]: ...  # flag, kg cm^2 | - | PhysicalProperties.getPrincipalMomentsOfInertia Method


class Occurrence(Protocol):
    name: str  # text | - | Occurrence.name Property
    fullPathName: str  # text, names with + between | - | Occurrence.fullPathName Property
    component: Component  # - | - | Occurrence.component Property
    transform2: Matrix  # - | root | Occurrence.transform2 Property
    childOccurrences: Collection  # - | root | Occurrence.childOccurrences Property
    isGrounded: bool  # flag | - | Occurrence.isGrounded Property
    isGroundToParent: bool  # flag | - | Occurrence.isGroundToParent Property
    isLightBulbOn: bool  # flag | - | Occurrence.isLightBulbOn Property


class Matrix(Protocol):
    def asArray(self) -> Sequence[float]: ...  # 16 numbers, rows, translation 3 7 11 in cm | root | Matrix3D.asArray Method


class Vector(Protocol):
    def asArray(self) -> Sequence[float]: ...  # unit vector | root | Vector3D.asArray Method


class Point(Protocol):
    def asArray(self) -> Sequence[float]: ...  # cm | as its owner | Point3D.asArray Method


class Body(Protocol):
    name: str  # text | - | BRepBody.name Property
    meshManager: MeshManager  # - | component | BRepBody.meshManager Property
    material: Material | None  # - | - | BRepBody.material Property
    appearance: Appearance | None  # - | - | BRepBody.appearance Property
    faces: Collection  # - | - | BRepBody.faces Property

    def getPhysicalProperties(self, accuracy: int) -> PhysicalProperties | None: ...  # CalculationAccuracy | - | BRepBody.getPhysicalProperties Method


class Face(Protocol):
    appearanceSourceType: int  # AppearanceSourceTypes | - | BRepFace.appearanceSourceType Property


class Material(Protocol):
    name: str  # text | - | Material.name Property


class Appearance(Protocol):
    name: str  # text | - | Appearance.name Property
    appearanceProperties: Properties  # - | - | Appearance.appearanceProperties Property


class Properties(Protocol):
    def itemById(self, id: str) -> ColorProperty | None: ...  # by key name | - | Properties.itemById Method


class ColorProperty(Protocol):
    value: Color | None  # - | - | ColorProperty.value Property


class Color(Protocol):
    red: int  # 0 to 255 | - | Color.red Property
    green: int  # 0 to 255 | - | Color.green Property
    blue: int  # 0 to 255 | - | Color.blue Property
    opacity: int  # 0 to 255 | - | Color.opacity Property


class MeshManager(Protocol):
    def createMeshCalculator(self) -> MeshCalculator: ...  # - | - | MeshManager.createMeshCalculator Method


class MeshCalculator(Protocol):
    def setQuality(self, quality: int) -> bool: ...  # TriangleMeshQualityOptions | - | TriangleMeshCalculator.setQuality Method
    def calculate(self) -> Mesh: ...  # - | - | TriangleMeshCalculator.calculate Method


class Mesh(Protocol):
    nodeCoordinatesAsDouble: Sequence[float]  # cm | component | TriangleMesh.nodeCoordinatesAsDouble Property
    nodeIndices: Sequence[int]  # from 0 | - | TriangleMesh.nodeIndices Property


class Joint(Protocol):
    name: str  # text | - | Joint.name Property
    occurrenceOne: Occurrence | None  # null = root | - | Joint.occurrenceOne Property
    occurrenceTwo: Occurrence | None  # null = root | - | Joint.occurrenceTwo Property
    geometryOneTransform: Matrix  # - | root | Joint.geometryOneTransform Property
    geometryTwoTransform: Matrix  # - | root | Joint.geometryTwoTransform Property
    jointMotion: Motion | None  # - | - | Joint.jointMotion Property
    motionLinks: Sequence[MotionLink]  # array | - | Joint.motionLinks Property
    isSuppressed: bool  # flag | - | Joint.isSuppressed Property
    isLocked: bool  # flag | - | Joint.isLocked Property
    healthState: int  # FeatureHealthStates | - | Joint.healthState Property


class AsBuiltJoint(Protocol):
    name: str  # text | - | AsBuiltJoint.name Property
    occurrenceOne: Occurrence | None  # null = root | - | AsBuiltJoint.occurrenceOne Property
    occurrenceTwo: Occurrence | None  # null = root | - | AsBuiltJoint.occurrenceTwo Property
    geometry: Geometry | None  # null of a rigid one | root | AsBuiltJoint.geometry Property
    jointMotion: Motion | None  # - | - | AsBuiltJoint.jointMotion Property
    motionLinks: Sequence[MotionLink]  # array | - | AsBuiltJoint.motionLinks Property
    isSuppressed: bool  # flag | - | AsBuiltJoint.isSuppressed Property


class Geometry(Protocol):
    origin: Point  # - | root | JointGeometry.origin Property
    primaryAxisVector: Vector  # the frame's Z | root | JointGeometry.primaryAxisVector Property
    secondaryAxisVector: Vector  # the frame's X | root | JointGeometry.secondaryAxisVector Property


class Motion(Protocol):
    jointType: int  # JointTypes | - | JointMotion.jointType Property
    rotationAxisVector: Vector  # - | root | RevoluteJointMotion.rotationAxisVector Property
    rotationValue: float  # rad | - | RevoluteJointMotion.rotationValue Property
    rotationLimits: Limits  # rad | - | RevoluteJointMotion.rotationLimits Property
    slideDirectionVector: Vector  # - | root | SliderJointMotion.slideDirectionVector Property
    slideValue: float  # cm | - | SliderJointMotion.slideValue Property
    slideLimits: Limits  # cm | - | SliderJointMotion.slideLimits Property
    normalDirectionVector: Vector  # - | root | PlanarJointMotion.normalDirectionVector Property
    primarySlideDirectionVector: Vector  # - | root | PlanarJointMotion.primarySlideDirectionVector Property
    primarySlideValue: float  # cm | - | PlanarJointMotion.primarySlideValue Property
    primarySlideLimits: Limits  # cm | - | PlanarJointMotion.primarySlideLimits Property
    secondarySlideValue: float  # cm | - | PlanarJointMotion.secondarySlideValue Property
    secondarySlideLimits: Limits  # cm | - | PlanarJointMotion.secondarySlideLimits Property
    pitchLimits: Limits  # rad | - | BallJointMotion.pitchLimits Property
    yawLimits: Limits  # rad | - | BallJointMotion.yawLimits Property
    rollLimits: Limits  # rad | - | BallJointMotion.rollLimits Property


class Limits(Protocol):
    isMinimumValueEnabled: bool  # flag | - | JointLimits.isMinimumValueEnabled Property
    minimumValue: float  # cm or rad | - | JointLimits.minimumValue Property
    isMaximumValueEnabled: bool  # flag | - | JointLimits.isMaximumValueEnabled Property
    maximumValue: float  # cm or rad | - | JointLimits.maximumValue Property


class MotionLink(Protocol):
    name: str  # text | - | MotionLink.name Property
    jointOne: Joint | AsBuiltJoint  # - | - | MotionLink.jointOne Property
    jointTwo: Joint | AsBuiltJoint | None  # null = the same joint | - | MotionLink.jointTwo Property
    motionOne: int  # MotionTypes | - | MotionLink.motionOne Property
    motionTwo: int  # MotionTypes | - | MotionLink.motionTwo Property
    valueOne: Parameter  # - | - | MotionLink.valueOne Property
    valueTwo: Parameter  # - | - | MotionLink.valueTwo Property
    isReversed: bool  # flag | - | MotionLink.isReversed Property
    isSuppressed: bool  # flag | - | MotionLink.isSuppressed Property


class Parameter(Protocol):
    value: float  # cm or rad | - | Parameter.value Property


class RigidGroup(Protocol):
    name: str  # text | - | RigidGroup.name Property
    occurrences: Collection  # - | - | RigidGroup.occurrences Property
    isSuppressed: bool  # flag | - | RigidGroup.isSuppressed Property


class AssemblyConstraint(Protocol):
    name: str  # text | - | AssemblyConstraint.name Property
    geometricRelationships: Collection  # - | - | AssemblyConstraint.geometricRelationships Property
    isSuppressed: bool  # flag | - | AssemblyConstraint.isSuppressed Property


class Relationship(Protocol):
    entityOne: Entity | None  # - | - | GeometricRelationship.entityOne Property
    entityTwo: Entity | None  # - | - | GeometricRelationship.entityTwo Property
    isMate: bool  # flag: else an angle | - | GeometricRelationship.isMate Property
    isFlipped: bool  # flag: aligned, else opposed | - | GeometricRelationship.isFlipped Property
    offsetOrAngle: Parameter | None  # - | - | GeometricRelationship.offsetOrAngle Property


class Entity(Protocol):
    assemblyContext: Occurrence | None  # null = root | - | BRepFace.assemblyContext Property
