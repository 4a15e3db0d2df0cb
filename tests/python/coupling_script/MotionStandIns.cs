// What moves KinefabCoupling's bodies and finds its components; Mono's compiler knows C# 7 and not the package's own stand-ins.
using System;
using System.Collections.Generic;
using System.Linq;

namespace UnityEngine
{
    public class MonoBehaviour : Component
    {
    }

    public sealed partial class Transform
    {
        public Vector3 position { get; set; }

        public Quaternion rotation { get; set; } = new Quaternion(0, 0, 0, 1);
    }

    public sealed partial class Rigidbody
    {
        public int Woken { get; private set; }

        public void WakeUp() => Woken++;

        public void MovePosition(Vector3 position) => transform.position = position;

        public void MoveRotation(Quaternion rotation) => transform.rotation = rotation;
    }

    public static class Searching
    {
        public static void GetComponents<T>(this GameObject own, List<T> found)
        {
            found.Clear();
            found.AddRange(own.Components.OfType<T>());
        }
    }
}
