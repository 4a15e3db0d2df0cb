using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>Holds each field of the format against Unity's member of that name; a field without one is a fault.</summary>
internal sealed class FieldComparison
{
    // What of the format is about the source, not for Unity. A joint that is not enabled is none there.
    private static readonly HashSet<string> AboutTheSource = [nameof(Joint.Id), nameof(Joint.Name), nameof(Joint.Part), nameof(Joint.ConnectedPart), nameof(Collider.Group), nameof(AnchoredJoint.Effort), nameof(AnchoredJoint.Speed), nameof(AnchoredJoint.Friction), nameof(AnchoredJoint.Armature), nameof(ConfigurableJoint.Stated), nameof(Joint.Because), nameof(Joint.Closure), nameof(Joint.Exact), nameof(DocumentObject.ExtrasJson)];

    // What Unity calls otherwise.
    private static readonly Dictionary<string, string> Names = new() { ["mesh"] = "sharedMesh", ["materials"] = "sharedMaterials", ["material"] = "sharedMaterial", ["linearLock"] = "linearLockX" };

    private readonly HashSet<string> _met = [];
    private readonly HashSet<string> _moved = [];
    private ValidScene _scene = null!;
    private Unity.GameObject[] _objects = [];

    /// <summary>Fields that stood at their default wherever they were met.</summary>
    public IEnumerable<string> AtDefaults => _met.Except(_moved).Order(StringComparer.Ordinal);

    /// <summary>How many fields were compared.</summary>
    public int Compared { get; private set; }

    public void Begin(ValidScene scene, Unity.GameObject[] objects) => (_scene, _objects) = (scene, objects);

    /// <summary>Asserts that all fields of an object of the document stand in Unity's.</summary>
    public void Same(object from, object to, string at) => Same(from, Activator.CreateInstance(from.GetType())!, to, at);

    private void Same(object from, object standard, object to, string at)
    {
        foreach (PropertyInfo field in from.GetType().GetProperties(BindingFlags.Public | BindingFlags.Instance).Where(p => !AboutTheSource.Contains(p.Name) && !(p.Name == nameof(Joint.Enabled) && p.DeclaringType == typeof(Joint))))
        {
            string name = char.ToLowerInvariant(field.Name[0]) + field.Name[1..];
            object? value = field.GetValue(from);
            object? found = Read(to, Names.GetValueOrDefault(name, name), at);
            if (value is DocumentObject part)
            {
                Same(part, field.GetValue(standard)!, found!, $"{at}.{name}");
                continue;
            }

            string key = $"{from.GetType().Name}.{field.Name}";
            _met.Add(key);
            Compared++;
            if (!Equals(value, field.GetValue(standard)) && !(value is System.Collections.ICollection { Count: 0 }))
                _moved.Add(key);
            Check(field, value, found, from, to, $"{at}.{name}");
        }
    }

    private static object? Read(object of, string name, string at)
    {
        MemberInfo? member = (MemberInfo?)of.GetType().GetProperty(name) ?? of.GetType().GetField(name);
        Assert.That(member, Is.Not.Null, $"{at}: Unity has no {name}");
        return member is PropertyInfo property ? property.GetValue(of) : ((FieldInfo)member!).GetValue(of);
    }

    private void Check(PropertyInfo field, object? value, object? found, object from, object to, string at)
    {
        Physics project = _scene.Document.Physics;
        switch (field.Name)
        {
            case nameof(Joint.ConnectedBody):
                Assert.That(((found as Unity.Component) ?? ((Unity.Joint)to).connectedArticulationBody)?.gameObject, value is int body ? Is.SameAs(_objects[body]) : Is.Null, at);
                break;
            case nameof(AnchoredJoint.ConnectedAnchor) when ((AnchoredJoint)from).AutoConfigureConnectedAnchor:
                break; // Unity's own value, not the file's
            case nameof(JointDrive.MaximumForce):
                Assert.That(found, Is.EqualTo((float)Math.Min((double)value!, 3.4028233e38f)), at);
                break;
            case nameof(ArticulationDrive.ForceLimit):
                Assert.That(found, Is.EqualTo((float)Math.Min((double)value!, 3.4028235e38f)), at);
                break;
            case nameof(ArticulationBody.MaxJointVelocity):
                Assert.That(found, Is.EqualTo((float)((double?)value ?? 100)), at);
                break;
            case nameof(ArticulationBody.Immovable):
                Assert.That(found, Is.EqualTo((bool)value!), at);
                break;
            case nameof(Rigidbody.InertiaTensor):
                Vector3d moments = (Vector3d)value!;
                Assert.That(Numbers(found!), Is.EqualTo(Numbers(new Vector3d(Math.Max(moments.X, 1e-9), Math.Max(moments.Y, 1e-9), Math.Max(moments.Z, 1e-9)))), at);
                break;
            case nameof(Rigidbody.MaxAngularVelocity):
                Assert.That(found, Is.EqualTo((float)((double?)value ?? project.DefaultMaxAngularSpeed)), at);
                break;
            case nameof(Rigidbody.SolverIterations):
                Assert.That(found, Is.EqualTo((int?)value ?? project.SolverIterations), at);
                break;
            case nameof(Rigidbody.SolverVelocityIterations):
                Assert.That(found, Is.EqualTo((int?)value ?? project.SolverVelocityIterations), at);
                break;
            case nameof(Collider.Material):
                if (value is not int physics)
                    Assert.That(found, Is.Null, at);
                else
                    Same(_scene.Document.PhysicsMaterials[physics], new PhysicsMaterial(), found!, at);
                break;
            case nameof(MeshFilter.Mesh):
                Assert.That(((Unity.Mesh)found!).name, Is.EqualTo(_scene.Document.Meshes[(int)value!].Name), at);
                break;
            case nameof(MeshRenderer.Materials):
                Assert.That(((Unity.Material[])found!).Select(m => m.name), Is.EqualTo(((IReadOnlyList<int>)value!).Select(i => _scene.Document.Materials[i].Name)), at);
                break;
            default:
                Assert.That(Numbers(found!), Is.EqualTo(Numbers(value!)).Within(value is Quaterniond ? 1e-6f : 0), at);
                break;
        }
    }

    // As Unity has them, in single precision.
    private static float[] Numbers(object value) => value switch
    {
        double number => [(float)number],
        float number => [number],
        int number => [number],
        bool flag => [flag ? 1 : 0],
        Enum word => [Convert.ToInt32(word)],
        Vector3d v => [(float)v.X, (float)v.Y, (float)v.Z],
        Quaterniond q => Unit(q.Normalized()),
        Unity.Vector3 v => [v.x, v.y, v.z],
        Unity.Quaternion q => [q.x, q.y, q.z, q.w],
        _ => throw new NotSupportedException(value.GetType().Name),
    };

    private static float[] Unit(Quaterniond q) => [(float)q.X, (float)q.Y, (float)q.Z, (float)q.W];
}
