// What Unity does to a component when its scripts are compiled anew while the editor plays.
using System;
using System.Reflection;
using System.Runtime.Serialization;
using Kinefab;
using UnityEngine;

public static partial class GearPair
{
    private static class Recompiled
    {
        private const BindingFlags Own = BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;

        public static void Run(KinefabCoupling coupling)
        {
            Call(coupling, "OnDisable");
            Fill(coupling, coupling);
            Call(coupling, "OnEnable");
        }

        // Private fields are kept too; of types that are not serializable, and of those that cannot be written to, nothing is.
        private static void Fill(object target, object source)
        {
            foreach (FieldInfo field in target.GetType().GetFields(Own | BindingFlags.DeclaredOnly))
            {
                bool isKept = !field.IsInitOnly && !field.IsNotSerialized;
                object blank = field.FieldType.IsValueType ? Activator.CreateInstance(field.FieldType) : null;
                field.SetValue(target, isKept ? Kept(field.GetValue(source), field.FieldType) ?? blank : blank);
            }
        }

        private static object Kept(object value, Type type)
        {
            if (value == null || type.IsPrimitive || type.IsEnum || typeof(UnityEngine.Object).IsAssignableFrom(type) || type.Namespace == "UnityEngine")
            {
                return value;
            }

            if (type.IsArray)
            {
                var from = (Array)value;
                Array made = Array.CreateInstance(type.GetElementType(), from.Length);
                for (int i = 0; i < from.Length; i++)
                {
                    made.SetValue(Kept(from.GetValue(i), type.GetElementType()), i);
                }

                return made;
            }

            if (!type.IsSerializable || typeof(Delegate).IsAssignableFrom(type))
            {
                return null;
            }

            object copy = FormatterServices.GetUninitializedObject(type);
            Fill(copy, value);
            return copy;
        }
    }
}
