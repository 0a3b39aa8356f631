using UnityEngine;

namespace UnityShim
{
    /// <summary>The state of a rigid body: its pose in the last and in the previous physics step, and the pose that
    /// physics last gave to its transform.</summary>
    internal sealed class BodyState
    {
        private readonly Rigidbody body;
        private Vector3 previousPosition;
        private Quaternion previousRotation;
        private Vector3 shownPosition;
        private Quaternion shownRotation;
        private Vector3? goal;

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

        public void Place(Vector3 position, Quaternion rotation)
        {
            Position = previousPosition = shownPosition = position;
            Rotation = previousRotation = shownRotation = rotation;
            body.transform.SetPositionAndRotation(position, rotation);
        }

        /// <summary>Moves the body to a transform that a script has moved.</summary>
        public void TakeTransform()
        {
            if (!body.transform.position.Equals(shownPosition) || !body.transform.rotation.Equals(shownRotation))
            {
                Place(body.transform.position, body.transform.rotation);
            }
        }

        public void Step()
        {
            TakeTransform();
            previousPosition = Position;
            previousRotation = Rotation;
            Position = goal ?? Position;
            goal = null;
        }

        /// <summary>An interpolated body is shown between its poses of the last two steps, one step late.</summary>
        public void Show(float share)
        {
            bool interpolated = body.interpolation == RigidbodyInterpolation.Interpolate;
            body.transform.SetPositionAndRotation(
                interpolated ? Vector3.Lerp(previousPosition, Position, share) : Position,
                interpolated ? Quaternion.Slerp(previousRotation, Rotation, share) : Rotation);
            shownPosition = body.transform.position;
            shownRotation = body.transform.rotation;
        }
    }
}
