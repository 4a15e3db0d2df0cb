"""The members of SolidWorks' API that the capture uses, and no others.

Behind each: unit | frame | page of the SolidWorks API help (2018 to 2025) that states it.  SolidWorks counts in metres,
radians and kilograms whatever the document's units.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

# fmt: off


class Application(Protocol):
    ActiveDoc: Model | None  # - | - | ISldWorks.ActiveDoc Property
    CommandInProgress: bool  # flag | - | ISldWorks.CommandInProgress Property

    def RevisionNumber(self) -> str: ...  # text, major = year - 1992 | - | ISldWorks.RevisionNumber Method


class Model(Protocol):
    ConfigurationManager: ConfigurationManager  # - | - | IModelDoc2.ConfigurationManager Property
    MaterialPropertyValues: Sequence[float] | None  # R G B ambient diffuse specular shininess transparency emission | - | IModelDoc2.MaterialPropertyValues Property
    MaterialUserName: str  # text | - | IPartDoc.MaterialUserName Property
    Extension: Extension  # - | - | IModelDoc2.Extension Property
    LengthUnit: int  # swLengthUnit_e | - | IModelDoc2.LengthUnit Property

    def GetType(self) -> int: ...  # swDocumentTypes_e | - | IModelDoc2.GetType Method
    def GetTitle(self) -> str: ...  # text | - | IModelDoc2.GetTitle Method
    def GetPathName(self) -> str: ...  # text | - | IModelDoc2.GetPathName Method
    def GetSaveFlag(self) -> bool: ...  # flag | - | IModelDoc2.GetSaveFlag Method
    def FirstFeature(self) -> Feature | None: ...  # - | - | IModelDoc2.FirstFeature Method
    def GetConfigurationCount(self) -> int: ...  # count | - | IModelDoc2.GetConfigurationCount Method
    def GetConfigurationByName(self, Name: str) -> Configuration | None: ...  # - | - | IModelDoc2.GetConfigurationByName Method


class Extension(Protocol):
    NeedsRebuild2: int  # 0 = built | - | IModelDocExtension.NeedsRebuild2 Property

    def CreateMassProperty2(self) -> MassProperty | None: ...  # - | - | IModelDocExtension.CreateMassProperty2 Method


class MassProperty(Protocol):
    UseSystemUnits: bool  # flag, set: m and kg | - | IMassProperty2.UseSystemUnits Property
    Mass: float  # kg | - | IMassProperty2.Mass Property
    CenterOfMass: Sequence[float]  # m | part | IMassProperty2.CenterOfMass Property
    PrincipalMomentsOfInertia: Sequence[float]  # kg m^2 | - | IMassProperty2.PrincipalMomentsOfInertia Property

    def GetMomentOfInertia(self, WhereTaken: int) -> Sequence[float]: ...  # kg m^2, 0 = about the centre: xx xy xz yx yy yz zx zy zz | part | IMassProperty2.GetMomentOfInertia Method


class ConfigurationManager(Protocol):
    ActiveConfiguration: Configuration  # - | - | IConfigurationManager.ActiveConfiguration Property


class Configuration(Protocol):
    Name: str  # text | - | IConfiguration.Name Property

    def GetRootComponent3(self, Resolve: bool) -> Component: ...  # - | - | IConfiguration.GetRootComponent3 Method


class Component(Protocol):
    Name2: str  # text, path from the root | - | IComponent2.Name2 Property
    Transform2: Transform | None  # - | root | IComponent2.Transform2 Property
    ReferencedConfiguration: str  # text | - | IComponent2.ReferencedConfiguration Property
    Visible: int  # swComponentVisibilityState_e | - | IComponent2.Visible Property
    Solving: int  # swComponentSolvingOption_e | - | IComponent2.Solving Property

    def GetChildren(self) -> Sequence[Component] | None: ...  # - | - | IComponent2.GetChildren Method
    def GetPathName(self) -> str: ...  # text | - | IComponent2.GetPathName Method
    def GetModelDoc2(self) -> Model | None: ...  # - | - | IComponent2.GetModelDoc2 Method
    def GetSuppression2(self) -> int: ...  # swComponentSuppressionState_e | - | IComponent2.GetSuppression2 Method
    def IsFixed(self) -> bool: ...  # flag, in the document asked | - | IComponent2.IsFixed Method
    def IsMirrored(self) -> bool: ...  # flag | - | IComponent2.IsMirrored Method
    def IsPatternInstance(self) -> bool: ...  # flag | - | IComponent2.IsPatternInstance Method
    def GetBodies2(self, BodyType: int) -> Sequence[Body] | None: ...  # - | part | IComponent2.GetBodies2 Method


class Transform(Protocol):
    ArrayData: Sequence[float]  # m: images of x y z, translation, scale | root | IMathTransform.ArrayData Property


class Body(Protocol):
    Name: str  # text | - | IBody2.Name Property

    def GetFaces(self) -> Sequence[Face] | None: ...  # - | part | IBody2.GetFaces Method


class Face(Protocol):
    def HasMaterialPropertyValues(self) -> bool: ...  # flag | - | IFace2.HasMaterialPropertyValues Method
    def GetTessTriangles(self, NoConversion: bool) -> Sequence[float] | None: ...  # m: nine numbers a triangle | part | IFace2.GetTessTriangles Method


class Feature(Protocol):
    Name: str  # text | - | IFeature.Name Property

    def GetTypeName2(self) -> str: ...  # text | - | IFeature.GetTypeName2 Method
    def GetNextFeature(self) -> Feature | None: ...  # - | - | IFeature.GetNextFeature Method
    def GetFirstSubFeature(self) -> Feature | None: ...  # - | - | IFeature.GetFirstSubFeature Method
    def GetNextSubFeature(self) -> Feature | None: ...  # - | - | IFeature.GetNextSubFeature Method
    def GetSpecificFeature2(self) -> Any: ...  # - | - | IFeature.GetSpecificFeature2 Method
    def GetDefinition(self) -> Any: ...  # - | - | IFeature.GetDefinition Method
    def IsSuppressed2(self, Config_opt: int, Config_names: None) -> Sequence[bool]: ...  # flags | - | IFeature.IsSuppressed2 Method
    def GetErrorCode(self) -> int: ...  # swFeatureError_e | - | IFeature.GetErrorCode Method


class Mate(Protocol):
    Type: int  # swMateType_e | - | IMate2.Type Property
    Alignment: int  # swMateAlign_e | - | IMate2.Alignment Property

    def GetMateEntityCount(self) -> int: ...  # number | - | IMate2.GetMateEntityCount Method
    def MateEntity(self, Index: int) -> MateEntity: ...  # from 0 | - | IMate2.MateEntity Method


class MateEntity(Protocol):
    EntityParams: Sequence[float]  # m: point, vector, two radii | owning assembly | IMateEntity2.EntityParams Property
    ReferenceType: int  # swMateEntity2ReferenceType_e | - | IMateEntity2.ReferenceType Property
    ReferenceComponent: Component | None  # - | - | IMateEntity2.ReferenceComponent Property
    Reference: Entity | None  # - | - | IMateEntity2.Reference Property


class Entity(Protocol):
    def GetComponent(self) -> Component | None: ...  # - | - | IEntity.GetComponent Method


class PatternData(Protocol):
    SeedComponentArray: Sequence[Feature] | None  # features of components | - | ILocalLinearPatternFeatureData.SeedComponentArray Property

    def AccessSelections(self, TopDoc: Model, Component: None) -> bool: ...  # flag | - | ILocalLinearPatternFeatureData.AccessSelections Method
    def ReleaseSelectionAccess(self) -> None: ...  # - | - | ILocalLinearPatternFeatureData.ReleaseSelectionAccess Method


class MateData(Protocol):
    LockRotation: bool  # flag | - | IConcentricMateFeatureData.LockRotation Property
    Distance: float  # m | - | IDistanceMateFeatureData.Distance Property
    IsAdvancedMate: bool  # flag | - | IDistanceMateFeatureData.IsAdvancedMate Property
    MinimumDistance: float  # m | - | IDistanceMateFeatureData.MinimumDistance Property
    MaximumDistance: float  # m | - | IDistanceMateFeatureData.MaximumDistance Property
    Angle: float  # rad | - | IAngleMateFeatureData.Angle Property
    MinimumAngle: float  # rad | - | IAngleMateFeatureData.MinimumAngle Property
    MaximumAngle: float  # rad | - | IAngleMateFeatureData.MaximumAngle Property
    GearRatioNumerator: float  # plain number | - | IGearMateFeatureData.GearRatioNumerator Property
    GearRatioDenominator: float  # plain number | - | IGearMateFeatureData.GearRatioDenominator Property
    Reverse: bool  # flag | - | IGearMateFeatureData.Reverse Property
    AngleSelection: bool  # flag | - | IHingeMateFeatureData.AngleSelection Property
    MinVal: float  # rad | - | IHingeMateFeatureData.MinVal Property
    MaxVal: float  # rad | - | IHingeMateFeatureData.MaxVal Property
    RevolutionType: int  # 0 revolutions a document unit, 1 distance a revolution | - | IScrewMateFeatureData.RevolutionType Property
    RevolutionVal: float  # m | - | IScrewMateFeatureData.RevolutionVal Property
    DiameterType: int  # 0 pitch diameter, 1 travel a revolution | - | IRackPinionMateFeatureData.DiameterType Property
    DiameterVal: float  # m | - | IRackPinionMateFeatureData.DiameterVal Property
    CouplerRatioNumerator: float  # plain number | - | ILinearCouplerMateFeatureData.CouplerRatioNumerator Property
    CouplerRatioDenominator: float  # plain number | - | ILinearCouplerMateFeatureData.CouplerRatioDenominator Property
    ConstraintType: int  # 0 centred, 1 free, 2 dimension, 3 percent | - | IWidthMateFeatureData.ConstraintType Property
    OffsetDistance: float  # m | - | IProfileCenterMateFeatureData.OffsetDistance Property
