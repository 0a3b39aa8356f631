using UnityEngine;

namespace UnityShim
{
    /// <summary>The state of a rigid body: its pose in the last and in the previous physics step, and the pose that
    /// physics last gave to its transform.</summary>
    internal sealed class BodyState
    {
        private readonly Rigidbody body;
        private Vector3 before;
        private Quaternion turnedBefore;
        private Vector3 shown;
        private Quaternion turnedShown;
        private Vector3? goal;
        private Quaternion? turnedGoal;

        public BodyState(Rigidbody body)
        {
            this.body = body;
            Place(body.transform.position, body.transform.rotation);
        }

        public Vector3 Position { get; private set; }

        public Quaternion Rotation { get; private set; }

        public static Rigidbody? Above(Transform? place)
        {
            for (; place is not null; place = place.parent)
            {
                if (place.gameObject.TryGetComponent(out Rigidbody found))
                {
                    return found;
                }
            }
            return null;
        }

        public void MoveTo(Vector3 position) => goal = position;

        public void TurnTo(Quaternion rotation) => turnedGoal = rotation;

        public void Place(Vector3 position, Quaternion rotation)
        {
            Position = before = shown = position;
            Rotation = turnedBefore = turnedShown = rotation;
            body.transform.SetPositionAndRotation(position, rotation);
        }

        /// <summary>Moves the body to a transform that a script has moved.</summary>
        public void TakeTransform()
        {
            if (!body.transform.position.Equals(shown) || !body.transform.rotation.Equals(turnedShown))
            {
                Place(body.transform.position, body.transform.rotation);
            }
        }

        public void Step()
        {
            TakeTransform();
            before = Position;
            turnedBefore = Rotation;
            Position = goal ?? Position;
            Rotation = turnedGoal ?? Rotation;
            goal = null;
            turnedGoal = null;
        }

        /// <summary>An interpolated body is shown between its poses of the last two steps, one step late.</summary>
        public void Show(float share)
        {
            bool interpolated = body.interpolation == RigidbodyInterpolation.Interpolate;
            body.transform.SetPositionAndRotation(
                interpolated ? Vector3.Lerp(before, Position, share) : Position,
                interpolated ? Quaternion.Slerp(turnedBefore, Rotation, share) : Rotation);
            shown = body.transform.position;
            turnedShown = body.transform.rotation;
        }
    }
}
