using System;
using System.Collections;
using System.Collections.Generic;
using System.Reflection;

namespace UnityEngine
{
    public interface ISerializationCallbackReceiver
    {
        void OnBeforeSerialize();

        void OnAfterDeserialize();
    }

    /// <summary>What Unity keeps of an object when it is copied, saved or its script is loaded anew.</summary>
    internal static class Copies
    {
        private const BindingFlags Own = BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic | BindingFlags.DeclaredOnly;

        // Of the engine's components: what it takes from scripts and saves in no scene and no prefab.
        private static readonly HashSet<string> Unsaved = new HashSet<string>
        {
            "maxAngularVelocity", "maxJointVelocity", "solverIterations", "solverVelocityIterations",
#if !UNITY_2022_2_OR_NEWER
            "centerOfMass", "inertiaTensor", "inertiaTensorRotation",
#endif
        };

        internal static bool IsCopying { get; private set; }

        /// <summary>Of an object: with all below it, references inside it turned to the copies.</summary>
        internal static Object Of(Object original, Transform parent)
        {
            var made = new Dictionary<Object, Object>();
            if (original is GameObject or Component)
            {
                GameObject from = original as GameObject ?? ((Component)original).gameObject;
                IsCopying = true;
                try
                {
                    GameObject root = Objects(from, made);
                    root.name = from.name + "(Clone)";
                    Fill(made);
                    root.transform.SetParent(parent, worldPositionStays: false);
                }
                finally
                {
                    IsCopying = false;
                }

                Player.Renew((GameObject)made[from]);
                return made[original];
            }

            var copy = (Object)Activator.CreateInstance(original.GetType(), nonPublic: true);
            made[original] = copy;
            Fill(made);
            copy.name = original.name + "(Clone)";
            return copy;
        }

        /// <summary>Leaves an object what is serialized; all else is as a new one has it.</summary>
        internal static void Forget(MonoBehaviour behaviour)
        {
            var fresh = Activator.CreateInstance(behaviour.GetType(), nonPublic: true);
            (behaviour as ISerializationCallbackReceiver)?.OnBeforeSerialize();
            foreach (FieldInfo field in Fields(behaviour.GetType(), typeof(MonoBehaviour)))
            {
                field.SetValue(behaviour, IsSerialized(field) ? Copy(field.GetValue(behaviour), field.FieldType, null) : field.GetValue(fresh));
            }

            (behaviour as ISerializationCallbackReceiver)?.OnAfterDeserialize();
        }

        /// <summary>Whether Unity serializes a field.</summary>
        internal static bool IsSerialized(FieldInfo field) =>
            !field.IsInitOnly && !field.IsDefined(typeof(NonSerializedAttribute)) && (field.IsPublic || field.IsDefined(typeof(SerializeField))) && IsSerializable(field.FieldType);

        internal static IEnumerable<FieldInfo> Fields(Type type, Type upTo)
        {
            for (; type != null && type != upTo && type != typeof(object); type = type.BaseType)
            {
                foreach (FieldInfo field in type.GetFields(Own))
                {
                    yield return field;
                }
            }
        }

        private static bool IsSerializable(Type type)
        {
            if (type.IsArray)
            {
                return type.GetArrayRank() == 1 && !type.GetElementType().IsArray && IsSerializable(type.GetElementType());
            }

            if (type.IsGenericType)
            {
                return type.GetGenericTypeDefinition() == typeof(List<>) && IsSerializable(type.GetGenericArguments()[0]);
            }

            return type.IsPrimitive || type.IsEnum || type == typeof(string) || typeof(Object).IsAssignableFrom(type)
                || (type.IsDefined(typeof(SerializableAttribute), inherit: false) && !typeof(Delegate).IsAssignableFrom(type) && type.Namespace?.StartsWith("System", StringComparison.Ordinal) != true);
        }

        private static GameObject Objects(GameObject from, Dictionary<Object, Object> made)
        {
            var to = new GameObject(from.name) { layer = from.layer, tag = from.tag, isStatic = from.isStatic };
            made[from] = to;
            made[from.transform] = to.transform;
            to.SetActive(from.activeSelf);
            to.transform.localPosition = from.transform.localPosition;
            to.transform.localRotation = from.transform.localRotation;
            to.transform.localScale = from.transform.localScale;
            foreach (Component component in from.Components)
            {
                if (component is not Transform)
                {
                    made[component] = to.AddComponent(component.GetType());
                }
            }

            foreach (Transform child in from.transform.Children)
            {
                Objects(child.gameObject, made).transform.SetParent(to.transform, worldPositionStays: false);
            }

            return to;
        }

        private static void Fill(Dictionary<Object, Object> made)
        {
            foreach (KeyValuePair<Object, Object> pair in made)
            {
                if (pair.Key is GameObject or Transform)
                {
                    continue;
                }

                bool isScript = pair.Key is MonoBehaviour or ScriptableObject;
                (pair.Key as ISerializationCallbackReceiver)?.OnBeforeSerialize();
                foreach (FieldInfo field in Fields(pair.Key.GetType(), pair.Key is Component ? typeof(Component) : typeof(Object)))
                {
                    bool isEngines = field.DeclaringType.Namespace?.StartsWith("UnityEngine", StringComparison.Ordinal) == true;
                    bool isUnsaved = isEngines && Unsaved.Contains(field.Name.TrimStart('_', '<').Replace(">k__BackingField", ""));
                    if (field.DeclaringType == typeof(MonoBehaviour) || isUnsaved || (isScript && !isEngines && !IsSerialized(field)))
                    {
                        continue;
                    }

                    field.SetValue(pair.Value, Copy(field.GetValue(pair.Key), field.FieldType, made));
                }

                (pair.Value as ISerializationCallbackReceiver)?.OnAfterDeserialize();
            }
        }

        // Values, lists and plain classes are copied, Unity's objects referred to; what is missing is empty afterwards, never null.
        private static object Copy(object value, Type type, Dictionary<Object, Object> made)
        {
            if (typeof(Object).IsAssignableFrom(type))
            {
                return value is Object of && made != null && made.TryGetValue(of, out Object copy) ? copy : value;
            }

            if (type == typeof(string))
            {
                return value ?? "";
            }

            if (type.IsArray)
            {
                var from = (Array)value ?? Array.CreateInstance(type.GetElementType(), 0);
                var to = Array.CreateInstance(type.GetElementType(), from.Length);
                for (int i = 0; i < from.Length; i++)
                {
                    to.SetValue(Copy(from.GetValue(i), type.GetElementType(), made), i);
                }

                return to;
            }

            if (type.IsGenericType && type.GetGenericTypeDefinition() == typeof(List<>))
            {
                var to = (IList)Activator.CreateInstance(type);
                foreach (object item in (IEnumerable)value ?? Array.Empty<object>())
                {
                    to.Add(Copy(item, type.GetGenericArguments()[0], made));
                }

                return to;
            }

            if (type.IsPrimitive || type.IsEnum || !type.IsDefined(typeof(SerializableAttribute), inherit: false))
            {
                return value;
            }

            object made2 = Activator.CreateInstance(type, nonPublic: true);
            foreach (FieldInfo field in Fields(type, typeof(object)))
            {
                if (value != null && IsSerialized(field))
                {
                    field.SetValue(made2, Copy(field.GetValue(value), field.FieldType, made));
                }
            }

            return made2;
        }
    }
}
